"""`suggest RECORDING…`: the next experiment that would best tell the remaining explanations apart."""

import argparse
import sys
from collections.abc import Sequence

from hasel_sim.parallel import executor
from ruamel.yaml import YAML

from hasel_sysid.command_line.inputs import load_inputs
from hasel_sysid.command_line.json_file import write_json
from hasel_sysid.command_line.parsers import suggest_parser
from hasel_sysid.command_line.progress import progress_bar
from hasel_sysid.command_line.running import run_command
from hasel_sysid.diagnosis import diagnose
from hasel_sysid.fit import fit_least_squares
from hasel_sysid.problem import Problem
from hasel_sysid.suggest import Suggestion, rivals, suggest

GOAL_FILE = "suggested_run.yaml"
_SHOWN = 5


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return run(suggest_parser().parse_args(arguments))


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    return run_command(lambda: _suggest(options))


def _suggest(options: argparse.Namespace) -> None:
    given = load_inputs(options)
    with executor(options.jobs, options.scheduler) as pool, progress_bar("suggest") as progress:
        problem = Problem(given.experiments, pool, given.noise)
        fit = fit_least_squares(problem, given.model, lambda text, share: progress(text, 0.15 * share))
        found = diagnose(
            problem, fit, options.effects, lambda text, share: progress(text, 0.15 + 0.6 * share)
        )
        ranked = suggest(
            pool,
            rivals(problem, found, named=bool(options.effects)),
            found.noise,
            options.max_voltage,
            lambda text, share: progress(text, 0.75 + 0.25 * share),
        )
    for suggestion in ranked[:_SHOWN]:
        print(suggestion)
    _write(ranked[0], options)


def _write(best: Suggestion, options: argparse.Namespace) -> None:
    if options.json:
        write_json(best.to_json(), options.json)
    if best.manoeuvre.load_factor is not None:
        return
    options.output.mkdir(parents=True, exist_ok=True)
    path = options.output / GOAL_FILE
    yaml = YAML(typ="safe")
    yaml.default_flow_style = False
    with path.open("w") as file:
        yaml.dump(best.manoeuvre.goal(), file)
    print(f"Wrote {path}, a goal for the RunExperiment action.")


if __name__ == "__main__":
    sys.exit(main())
