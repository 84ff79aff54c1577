# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`fit RECORDING…`: identify a model's free parameters and write the fitted model."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hasel_common.progress import progress_bar
from hasel_sim.errors import ClusterError, SimulationError
from hasel_sim.model import Model, save_model

from hasel_sysid.command_line.inputs import load_inputs, that_can_be_simulated
from hasel_sysid.command_line.options import fit_parser
from hasel_sysid.command_line.running import told, workers, write_json
from hasel_sysid.command_line.shown import code_after, show
from hasel_sysid.comparison import Comparison, compare
from hasel_sysid.data_quality import DataFinding
from hasel_sysid.errors import SysidError
from hasel_sysid.estimation import FittedModel, identify
from hasel_sysid.expected_work import COMPARISON, USUAL_SPEED, plan_of_fit, work_of
from hasel_sysid.problem import Evaluation, Problem
from hasel_sysid.report.from_results import fit_content
from hasel_sysid.report.pictures import vector_figures
from hasel_sysid.report.write import write_report

MODEL_FILE = "fitted_model.yaml"


class BestSoFar(Problem):
    """best: the evaluation with the least sum of squares so far; None before the first."""

    best: Evaluation | None = None

    def evaluate_each(
        self, models: Sequence[Model], names: Sequence[Sequence[str]]
    ) -> list[Evaluation | SimulationError]:
        """As the problem itself does."""
        found = super().evaluate_each(models, names)
        for evaluation in found:
            if isinstance(evaluation, SimulationError):
                continue
            if self.best is None or evaluation.sum_of_squares < self.best.sum_of_squares:
                self.best = evaluation
        return found


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return run(fit_parser().parse_args(arguments))


@told
def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    given = load_inputs(options)
    if not given.model.free:
        raise SysidError(
            f"model '{given.label}' has no free parameter; expected at least one: add an effect with `add`, "
            "or set free: true in the model file"
        )
    options.output.mkdir(parents=True, exist_ok=True)
    problem, size = None, work_of(given.model, [each.run for each in given.experiments])
    try:
        with (
            workers(options) as pool,
            progress_bar("fit", plan_of_fit(size), usual_speed=USUAL_SPEED) as work,
        ):
            given = that_can_be_simulated(given, pool)
            problem = BestSoFar(given.experiments, pool, workload=work)
            result = identify(problem, given.model, options.method)
            label = f"{given.label}, fitted"
            with problem.workload.stage(COMPARISON):
                comparison = compare(result.model, given.experiments, pool, given.unseen, label, work)
    except (KeyboardInterrupt, ClusterError):
        if problem is not None and problem.best is not None:
            path = _save(given.model.with_values(problem.best.model.values), options.output)
            print(f"wrote the best model so far, without uncertainties, to {path}", file=sys.stderr)
        raise
    _finish(options, result, comparison, given.said)
    return code_after(comparison.set_up)


def _finish(
    options: argparse.Namespace, result: FittedModel, comparison: Comparison, said: Sequence[DataFinding]
) -> None:
    path = _save(result.model, options.output)
    show([comparison], said)
    print(result)
    if options.json:
        write_json({**comparison.to_json(), **_fit_json(result)}, options.json)
    content = fit_content(result, comparison)
    report = write_report(content, options.output)
    vector_figures(content, options.output)
    print(f"Wrote {path} and {report}, and its figures as SVG.")


def _fit_json(result: FittedModel) -> dict[str, Any]:
    names = result.evaluation.names
    parameters = {
        name: {
            "value": result.model.parameters[name].value,
            "std": result.model.parameters[name].standard_error,
            "correlations": result.model.parameters[name].correlations,
            "unit": result.model.parameters[name].unit,
            "at_bound": name in result.at_bound,
            "determined": name not in result.undetermined,
        }
        for name in names
    }
    return {
        "method": result.method,
        "parameters": parameters,
        "mae_fit": result.mean_absolute_error,
        "messages": result.sentences,
    }


def _save(model: Model, folder: Path) -> Path:
    path = folder / MODEL_FILE
    save_model(model, path)
    return path


if __name__ == "__main__":
    sys.exit(main())
