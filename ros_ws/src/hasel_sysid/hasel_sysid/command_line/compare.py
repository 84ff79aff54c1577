# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`compare RECORDING…`: how far and where a model is off, with a report."""

import argparse
import sys
from collections.abc import Sequence

from hasel_common.progress import Stage, progress_bar
from hasel_sim.errors import SimulationError

from hasel_sysid.command_line.inputs import chosen_model, load_all
from hasel_sysid.command_line.options import compare_parser
from hasel_sysid.command_line.running import told, workers, write_json
from hasel_sysid.command_line.shown import code_after, show
from hasel_sysid.comparison import Comparison, compare
from hasel_sysid.dataset import for_model, simulable
from hasel_sysid.expected_work import USUAL_SPEED, work_of
from hasel_sysid.report.from_results import comparison_content, never_fitted
from hasel_sysid.report.write import write_report

_FEW_FRAMES = 3000
"""Simulated in some two seconds of one core; a process of its own needs one to start."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return run(compare_parser().parse_args(arguments))


@told
def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    experiments, unseen = load_all(options)
    names = options.model or [None]
    seen = len(experiments)
    recordings = [each.recording for each in (*experiments, *unseen)]
    models = [chosen_model(name, recordings) for name in names]
    comparisons: list[Comparison] = []
    firsts: list[str] = []
    try:
        runs = [each.run for each in (*experiments, *unseen)]
        jobs = 1 if len(models) * sum(len(run.time) for run in runs) < _FEW_FRAMES else None
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
