"""`bench_muscle RECORDING…`: compare one muscle's stroke and force with its law, learn what that lacks, add it."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from hasel_common.progress import progress_bar
from hasel_sim.model.muscle_file import muscle_text
from hasel_sim.muscle.effect import muscle_catalogue
from hasel_sim.muscle.muscle import Muscle
from hasel_sysid.command_line.running import run_command, write_json
from hasel_sysid.errors import SysidError
from hasel_sysid.expected_work import plan_of_search
from rich.console import Console

from hasel_muscle import shown
from hasel_muscle.improve import described, fit_muscle, improve_muscle
from hasel_muscle.muscle_report import write_report
from hasel_muscle.muscle_runs import muscle_for, readable, settled_runs
from hasel_muscle.options import bench_muscle_parser
from hasel_muscle.problem import BenchProblem, as_muscle, bench_problem
from hasel_muscle.result import BenchImprovement
from hasel_muscle.stroke_picture import write_picture
from hasel_muscle.stroke_table import Rival, rival_table
from hasel_muscle.swinging import Swinging, swinging
from hasel_muscle.where_it_fails import where_it_fails

MUSCLE_FILE, PICTURE_FILE, REPORT_FILE = "muscle.yaml", "bench_muscle.png", "bench_muscle.html"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return run(bench_muscle_parser().parse_args(arguments))


def run(options: argparse.Namespace) -> int:
    """Run the command with these options."""
    return run_command(lambda: _bench(options))


def _bench(options: argparse.Namespace) -> None:
    console = Console(highlight=False)
    paths = [path for given in (options.recordings, options.validate) for path in given]
    muscle = muscle_for(options.muscle, paths)
    if options.effects:
        muscle.with_effects(*options.effects)  # refuses unknown names before anything takes time
    fitted, unseen = _problems(options)
    if options.fit_only:
        _fit_only(fitted, unseen, muscle, options, console)
        return
    candidates = len(options.effects or muscle_catalogue())
    with progress_bar("fit", plan_of_search(1.0, candidates), "evaluations") as fitted.workload:
        found = improve_muscle(fitted, muscle, unseen, options.effects or None)
    fails = where_it_fails(fitted, found.stages[1].muscle)
    rival = rival_table(fitted, unseen, found.muscle) if unseen is not None else None
    swings = swinging(readable(options.recordings, options.map), found.muscle, options.unseen_voltages)
    named = [("formula", found.stages[0]), ("fitted", found.stages[1])]
    named += [("with effects", found.stages[-1])] if found.missing else []
    muscles = [(name, stage.muscle) for name, stage in named]
    console.print(shown.stroke_table(fitted, muscles, unseen))
    console.print(shown.stage_table(found))
    if swings is not None:
        console.print(shown.lift_table(swings))
    _say(["The fitted law:", *(f"  {each}" for each in fails)] if fails else [], console)
    _say([*shown.sentences(found), *map(str, filter(None, (rival, swings)))], console)
    if options.all:
        _say([str(each) for each in found.findings], console)
    else:
        console.print(f"(what is said of all {len(found.findings)} effects: --all, and in the report)")
    _write(found, fails, rival, swings, fitted, unseen, options, console)


def _say(lines: Sequence[str], console: Console) -> None:
    for line in lines:
        console.print(line, markup=False, soft_wrap=True)


def _problems(options: argparse.Namespace) -> tuple[BenchProblem, BenchProblem | None]:
    """What is fitted, and what is not seen: whole recordings, or single voltages of those that are fitted."""
    every = bench_problem(settled_runs(options.recordings, options.settling, options.map))
    apart = list(options.unseen_voltages)
    missing = [volts for volts in apart if volts not in every.voltages]
    if missing:
        known = ", ".join(f"{level:g}" for level in every.voltages)
        raise SysidError(
            f"no lift is at {missing[0]:g} V; expected some of {known}: correct --unseen-voltages"
        )
    if set(apart) >= set(every.voltages.tolist()):
        raise SysidError(
            "all voltages are unseen, so that nothing is left to fit: name fewer with --unseen-voltages"
        )
    fitted = every.only_levels(apart, keep=False)
    runs = [*every.only_levels(apart).runs] if apart else []
    if options.validate:
        runs += settled_runs(options.validate, options.settling, options.map)
    return fitted, bench_problem(runs, {**bench_problem(runs).scales, **fitted.scales}) if runs else None


def _fit_only(
    fitted: BenchProblem,
    unseen: BenchProblem | None,
    muscle: Muscle,
    options: argparse.Namespace,
    console: Console,
) -> None:
    fit = fit_muscle(fitted, muscle.with_effects(*options.effects) if options.effects else muscle)
    law = as_muscle(fit.model)
    console.print(shown.stroke_table(fitted, [("formula", muscle), ("fitted", law)], unseen))
    _say([*where_it_fails(fitted, law), shown.fitted(fit), str(described(fitted, fit))], console)
    _write_muscle(law, options.output, console)


def _write(
    found: BenchImprovement,
    fails: tuple[str, ...],
    rival: Rival | None,
    swings: Swinging | None,
    fitted: BenchProblem,
    unseen: BenchProblem | None,
    options: argparse.Namespace,
    console: Console,
) -> None:
    picture = options.output / PICTURE_FILE
    write_picture(found, fitted, unseen, picture)
    write_report(found, fails, rival, swings, picture, options.output / REPORT_FILE)
    if options.json:
        write_json(shown.to_json(found, rival, swings), options.json)
    _write_muscle(found.muscle, options.output, console, f", {PICTURE_FILE} and {REPORT_FILE}")


def _write_muscle(muscle: Muscle, folder: Path, console: Console, others: str = "") -> None:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / MUSCLE_FILE).write_text(muscle_text(muscle), encoding="utf-8")
    _say([f"Wrote {folder / MUSCLE_FILE}{others}."], console)


if __name__ == "__main__":
    sys.exit(main())
