# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
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

from hasel_muscle import bench_report
from hasel_muscle.bench_files import muscle_for, readable, settled_runs
from hasel_muscle.bench_improvement import described, fit_muscle, improve_muscle
from hasel_muscle.bench_problem import BenchProblem, as_muscle
from hasel_muscle.bench_report import BenchResult
from hasel_muscle.entry import bench_muscle_parser
from hasel_muscle.law_check import rival_table, where_it_fails
from hasel_muscle.swinging import swinging

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
        fit = fit_muscle(fitted, muscle.with_effects(*options.effects) if options.effects else muscle)
        law = as_muscle(fit.model)
        console.print(bench_report.stroke_table(fitted, [("formula", muscle), ("fitted", law)], unseen))
        _say([*where_it_fails(fitted, law), bench_report.fitted(fit), str(described(fitted, fit))], console)
        _write_muscle(law, options.output, console)
        return
    candidates = len(options.effects or muscle_catalogue())
    with progress_bar("fit", plan_of_search(1.0, candidates), "evaluations") as fitted.workload:
        found = improve_muscle(fitted, muscle, unseen, options.effects)
    result = BenchResult(
        found,
        fitted,
        unseen,
        where_it_fails(fitted, found.stages[1].muscle),
        rival_table(fitted, unseen, found.muscle) if unseen is not None else None,
        swinging(readable(options.recordings, options.map), found.muscle, options.unseen_voltages),
    )
    _tell(result, options.all, console)
    picture = options.output / PICTURE_FILE
    bench_report.write_picture(result, picture)
    bench_report.write_report(result, picture, options.output / REPORT_FILE)
    if options.json:
        write_json(bench_report.to_json(result), options.json)
    _write_muscle(found.muscle, options.output, console, f", {PICTURE_FILE} and {REPORT_FILE}")


def _tell(result: BenchResult, every_effect: bool, console: Console) -> None:
    found, swings = result.found, result.swings
    muscles = [("formula", found.stages[0].muscle), ("fitted", found.stages[1].muscle)]
    muscles += [("with effects", found.muscle)] if found.missing else []
    console.print(bench_report.stroke_table(result.fitted, muscles, result.unseen))
    console.print(bench_report.stage_table(found))
    if swings is not None:
        console.print(bench_report.lift_table(swings))
    _say(["The fitted law:", *(f"  {each}" for each in result.fails)] if result.fails else [], console)
    _say([*bench_report.sentences(found), *map(str, filter(None, (result.rival, swings)))], console)
    if every_effect:
        _say(list(map(str, found.findings)), console)
    else:
        console.print(f"(what is said of all {len(found.findings)} effects: --all, and in the report)")


def _say(lines: Sequence[str], console: Console) -> None:
    for line in lines:
        console.print(line, markup=False, soft_wrap=True)


def _problems(options: argparse.Namespace) -> tuple[BenchProblem, BenchProblem | None]:
    """What is fitted, and what is not seen: whole recordings, or single voltages of those that are fitted."""
    every = BenchProblem(settled_runs(options.recordings, options.settling, options.map))
    apart = list(options.unseen_voltages)
    missing = [volts for volts in apart if volts not in every.voltages]
    if missing:
        known = ", ".join(f"{level:g}" for level in every.voltages)
        said = f"no lift is at {missing[0]:g} V; expected some of {known}"
        raise SysidError(f"{said}: correct --unseen-voltages")
    if set(apart) >= set(every.voltages.tolist()):
        raise SysidError(
            "all voltages are unseen, so that nothing is left to fit: name fewer with --unseen-voltages"
        )
    fitted = every.only_levels(apart, keep=False)
    runs = [*every.only_levels(apart).runs] if apart else []
    if options.validate:
        runs += settled_runs(options.validate, options.settling, options.map)
    return fitted, BenchProblem(runs, {**BenchProblem(runs).scales, **fitted.scales}) if runs else None


def _write_muscle(muscle: Muscle, folder: Path, console: Console, others: str = "") -> None:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / MUSCLE_FILE).write_text(muscle_text(muscle), encoding="utf-8")
    _say([f"Wrote {folder / MUSCLE_FILE}{others}."], console)


if __name__ == "__main__":
    sys.exit(main())
