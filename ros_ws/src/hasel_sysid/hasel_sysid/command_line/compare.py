"""`compare RECORDING…`: how far and where a model is off, with a report."""

import argparse
import sys
from collections.abc import Sequence

from hasel_common.progress import Stage, progress_bar
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.command_line.chosen_model import chosen_model
from hasel_sysid.command_line.inputs import load_all
from hasel_sysid.command_line.json_file import write_json
from hasel_sysid.command_line.parsers import compare_parser
from hasel_sysid.command_line.running import run_command
from hasel_sysid.command_line.shown import code_after, show
from hasel_sysid.command_line.workers import workers
from hasel_sysid.compare import Comparison, compare
from hasel_sysid.dataset import for_model, simulable
from hasel_sysid.expected_work import USUAL_SPEED, work_of
from hasel_sysid.experiment import Experiment
from hasel_sysid.report.from_results import comparison_content, never_fitted
from hasel_sysid.report.write import write_report

_FEW_FRAMES = 3000
"""Simulated in some two seconds of one core; a process of its own needs one to start."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return run(compare_parser().parse_args(arguments))


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    return run_command(lambda: _compare(options))


def _compare(options: argparse.Namespace) -> int:
    experiments, unseen = load_all(options)
    names = options.model or [None]
    seen = len(experiments)
    recordings = [each.recording for each in (*experiments, *unseen)]
    models = [chosen_model(name, recordings) for name in names]
    comparisons: list[Comparison] = []
    firsts: list[str] = []
    try:
        jobs = _worth_it(models, [*experiments, *unseen])
        runs = [each.run for each in (*experiments, *unseen)]
        stage = Stage("compare", sum(work_of(model, runs) for _, model in models), known=True)
        with (
            workers(options, jobs) as pool,
            progress_bar("compare", [stage], usual_speed=USUAL_SPEED) as work,
            work.stage(stage),
        ):
            for label, model in models:
                firsts.append(never_fitted(label, model))
                if firsts[-1]:
                    print(f"note: {firsts[-1]}", file=sys.stderr)

                every = for_model(model, [*experiments, *unseen])
                fitted, others = every[:seen], every[seen:]
                try:
                    found = compare(model, fitted, pool, others, label, work)
                except SimulationError:
                    fitted, others = (simulable(model, part, pool) for part in (fitted, others))
                    found = compare(model, fitted, pool, others, label, work)
                comparisons.append(found)
    except KeyboardInterrupt:
        if comparisons:
            _finish(options, comparisons, firsts)
            print(f"{len(comparisons)} of {len(models)} models were compared", file=sys.stderr)
        raise
    _finish(options, comparisons, firsts)
    return code_after(comparisons[0].set_up)


def _worth_it(models: Sequence[tuple[str, Model]], experiments: Sequence[Experiment]) -> int | None:
    """1 where starting further processes takes longer than simulating every frame here, otherwise one per core."""
    frames = len(models) * sum(len(each.run.time) for each in experiments)
    return 1 if frames < _FEW_FRAMES else None


def _finish(options: argparse.Namespace, comparisons: Sequence[Comparison], firsts: Sequence[str]) -> None:
    show(comparisons)
    if options.json:
        first = comparisons[0].to_json()
        several = {"models": [c.to_json() for c in comparisons]} if len(comparisons) > 1 else {}
        write_json({**first, **several}, options.json)
    report = write_report(comparison_content(comparisons, firsts), options.output)
    print(f"Wrote {report}.")


if __name__ == "__main__":
    sys.exit(main())
