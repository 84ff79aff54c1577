# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`suggest RECORDING…`: the next experiment that would best tell the remaining explanations apart."""

import argparse
import sys
from collections.abc import Sequence
from functools import partial

from hasel_common.progress import progress_bar
from hasel_common.yaml_text import yaml_text
from hasel_recording import HASEL_PAIR
from hasel_sim.model import Model

from hasel_sysid.answer.next_run import Suggestion, fitted_briefly, rivals, suggest
from hasel_sysid.candidates import effects_of
from hasel_sysid.command_line.inputs import load_inputs, that_can_be_simulated
from hasel_sysid.command_line.options import suggest_parser
from hasel_sysid.command_line.running import told, workers, write_json
from hasel_sysid.errors import SysidError
from hasel_sysid.estimation import fit_baseline
from hasel_sysid.expected_work import USUAL_SPEED, plan_of_suggest, work_of
from hasel_sysid.improvement import diagnose
from hasel_sysid.problem import Problem

GOAL_FILE = "suggested_run.yaml"
_SHOWN = 5
_SAFE_VOLTAGE = 5500.0


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return run(suggest_parser().parse_args(arguments))


@told
def run(options: argparse.Namespace) -> None:
    """Run the command with these options; returns its exit code."""
    given = load_inputs(options)
    size = work_of(given.model, [each.run for each in given.experiments])
    plan = plan_of_suggest(size, len(effects_of(given.model, options.effects)))
    with workers(options) as pool, progress_bar("suggest", plan, usual_speed=USUAL_SPEED) as work:
        given = that_can_be_simulated(given, pool)
        problem = Problem(given.experiments, pool, given.noise, workload=work)
        named = any(not name.startswith("+") for name in options.effects or ())
        fit = fit_baseline(problem, given.model)
        found = diagnose(problem, fit, options.effects)
        ranked = suggest(
            pool,
            rivals(found, partial(fitted_briefly, problem) if named else None),
            found.noise,
            _highest(options.max_level, given.model),
            work,
        )
    if not ranked:
        raise SysidError(
            "no experiment of the library can be simulated with these explanations: plan the next by hand"
        )
    for suggestion in ranked[:_SHOWN]:
        print(suggestion)
    _write(ranked[0], options)


def _highest(asked: float | None, model: Model) -> float:
    """The highest level to propose: what was asked for, else what is safe for the rig or was recorded already."""
    if asked is not None:
        return asked
    return _SAFE_VOLTAGE if model.drive_unit == "V" else float(max(model.levels, default=0.0))


def _write(best: Suggestion, options: argparse.Namespace) -> None:
    if options.json:
        write_json(best.to_json(), options.json)
    if best.manoeuvre.load_factor is not None:
        return
    options.output.mkdir(parents=True, exist_ok=True)
    path = options.output / GOAL_FILE
    path.write_text(yaml_text(dict(sorted(best.manoeuvre.goal().items()))), encoding="utf-8")
    action = ", a goal for the RunExperiment action" if best.manoeuvre.channels == HASEL_PAIR else ""
    print(f"Wrote {path}{action}.")


if __name__ == "__main__":
    sys.exit(main())
