# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`improve RECORDING…`: fit, diagnose, add, refit, and write what was found at every stage."""

import argparse
import json
import sys
from collections.abc import Sequence
from concurrent.futures import Executor
from pathlib import Path

from hasel_common.progress import Workload, progress_bar
from hasel_sim.model import Model, save_model
from hasel_sim.parallel import simulate_all

from hasel_sysid.answer.next_run import Suggestion, in_doubt, suggest
from hasel_sysid.answer.result import Improvement, Stage, Status, table_of_models
from hasel_sysid.answer.set_up import DECIDED
from hasel_sysid.candidates import effects_of
from hasel_sysid.command_line.inputs import load_inputs, that_can_be_simulated
from hasel_sysid.command_line.options import improve_parser
from hasel_sysid.command_line.running import MISLEADING, told, workers, write_json
from hasel_sysid.command_line.shown import code_after, show, summarise, tell
from hasel_sysid.command_line.summary import improvement_lines
from hasel_sysid.comparison import Comparison, compare, comparison_of
from hasel_sysid.data_quality import DataFinding
from hasel_sysid.expected_work import START, USUAL_SPEED, TimeLimit, plan_of_improve, work_of
from hasel_sysid.experiment import Experiment
from hasel_sysid.improvement import improve
from hasel_sysid.problem import Problem
from hasel_sysid.report.from_improvement import improvement_content
from hasel_sysid.report.pictures import stages_picture, vector_figures, waterfall_picture
from hasel_sysid.report.write import write_report

MODEL_FILE = "improved_model.yaml"


class Ledger:
    """Writes `stage_<n>_<effects>.yaml` and one line of `ledger.jsonl` for every stage as soon as it is known."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.path = folder, folder / "ledger.jsonl"
        self.path.write_text("")
        self._count = 0

    def add(self, stage: Stage) -> None:
        """Write a stage's model and what was found there."""
        name = "_".join([f"stage_{self._count}", *(stage.added or ("baseline",))]) + ".yaml"
        save_model(stage.fit.model, self.folder / name)
        self._count += 1
        best = None if stage.diagnosis is None else stage.diagnosis.best
        line = {
            "model": name,
            "effects": list(stage.effects),
            "constant": stage.constant or None,
            "mae_fit": stage.mae_fit,
            "mae_validation": stage.mae_validation,
            "next": None if best is None else {"effect": best.effect, "finding": str(best)},
        }
        with self.path.open("a") as file:
            file.write(json.dumps(line, ensure_ascii=False) + "\n")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return run(improve_parser().parse_args(arguments))


@told
def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    given = load_inputs(options, DECIDED)
    label, model = given.label, given.model
    options.output.mkdir(parents=True, exist_ok=True)
    limit = TimeLimit(options.seconds)
    ledger, written = Ledger(options.output), []

    def keep(stage: Stage) -> None:
        ledger.add(stage)
        written.append(stage)

    try:
        size = work_of(model, [each.run for each in given.experiments])
        plan = plan_of_improve(size, len(effects_of(model, options.effects)))
        with workers(options) as pool, progress_bar("improve", plan, usual_speed=USUAL_SPEED) as work:
            with work.stage(START):
                given = that_can_be_simulated(given, pool)
                experiments, unseen = given.experiments, given.unseen
                start = compare(model, experiments, pool, unseen, label, work)
            problem = Problem(experiments, pool, given.noise, limit, work)
            validation = Problem(unseen, pool, workload=work) if unseen else None
            found = improve(problem, model, validation, options.effects, on_stage=keep)
            if found.set_up:
                experiments, unseen = found.set_up.read(experiments), found.set_up.read(unseen)
            stages = [_comparison(stage, experiments, unseen, pool, label) for stage in found.stages]
            suggestions = [] if limit.is_over() else _next_runs(found, pool, work)
    except KeyboardInterrupt:
        if written:
            print(f"wrote the stages so far ({len(written)}), see {ledger.path}", file=sys.stderr)
        raise
    fitted = _undecided(stages[0])
    suspected = list(dict.fromkeys((*_undecided(start), *fitted)))
    tell(suspected, given.said)

    def everything() -> None:
        show([stages[0]], stages[0].set_up)  # what is said of the set-up was told before
        print(found.diagnosis)
        print(found)
        print(table_of_models(found.models))

    lines = improvement_lines(found, stages, suggestions)
    further = len(found.diagnosis.findings) - 1
    others = "tables of all runs, where the model fails" + (
        f", the other {further} effects" if further > 1 else ", the other effect" if further else ""
    )
    summarise(lines, everything, options.all, others)
    _finish(options, found, start, stages, suggestions, suspected)
    return MISLEADING if found.set_up else code_after([*given.said, *fitted])


def _undecided(comparison: Comparison) -> list[DataFinding]:
    return [finding for finding in comparison.set_up if finding.fault not in DECIDED]


def _next_runs(found: Improvement, pool: Executor, work: Workload) -> list[Suggestion]:
    """The runs that would best tell apart what is still in doubt, at no more voltage than was used already."""
    candidates = in_doubt(found.diagnosis, found.missing)
    if found.set_up or found.constant or found.status is Status.NOTHING_MISSING or len(candidates) < 2:
        return []
    highest = max(found.model.levels, default=0.0)
    return suggest(pool, candidates, found.diagnosis.noise, highest, work, brief=True)


def _comparison(
    stage: Stage, experiments: Sequence[Experiment], unseen: Sequence[Experiment], pool: Executor, label: str
) -> Comparison:
    """A stage's comparison; its fitted runs have been simulated already."""
    model: Model = stage.fit.model
    simulations = [*stage.fit.evaluation.simulations, *simulate_all(pool, model, [e.run for e in unseen])]
    name = " + ".join([f"{label}, fitted", *stage.added])
    return comparison_of(model, experiments, simulations, unseen, name)


def _finish(
    options: argparse.Namespace,
    found: Improvement,
    start: Comparison,
    stages: Sequence[Comparison],
    suggestions: Sequence[Suggestion],
    suspected: Sequence[DataFinding],
) -> None:
    folder: Path = options.output
    save_model(found.model, folder / MODEL_FILE)
    content = improvement_content(found, stages, start, suggestions)
    report = write_report(content, folder)
    vector_figures(content, folder)
    waterfall_picture(content.stages, content.noise_floor, folder / "waterfall.png")
    stages_picture(content.stages, content.noise_floor, folder / "error_by_stage.png")
    if options.json:
        details = {
            "where_it_fails": stages[0].where.sentences(),
            "data_gate": [finding.to_json() for finding in suspected],
            "start": start.to_json(),
            "next_runs": [suggestion.to_json() for suggestion in suggestions],
        }
        write_json({**found.to_json(), **details}, options.json)
    print(f"Wrote {folder / MODEL_FILE} and {report}, and its figures as SVG.")


if __name__ == "__main__":
    sys.exit(main())
