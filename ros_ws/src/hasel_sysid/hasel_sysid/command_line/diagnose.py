"""`diagnose RECORDING…`: rank the missing effects, with a verdict each."""

import argparse
import sys
from collections.abc import Sequence

from hasel_sim.parallel import executor

from hasel_sysid.command_line.json_file import write_json
from hasel_sysid.command_line.options import (
    add_effects,
    add_model,
    add_recordings,
    add_results,
    add_workers,
    chosen_model,
    load_all,
)
from hasel_sysid.command_line.progress import part, progress_bar
from hasel_sysid.command_line.running import run_command
from hasel_sysid.command_line.shown import announce, show
from hasel_sysid.compare import compare
from hasel_sysid.dataset import prepared
from hasel_sysid.diagnosis import diagnose
from hasel_sysid.fit import fit_least_squares
from hasel_sysid.improve.result import diagnosis_json
from hasel_sysid.problem import Problem
from hasel_sysid.report.from_diagnosis import diagnosis_content
from hasel_sysid.report.write import write_report


def parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(prog="diagnose", description="Rank the effects that a model may lack.")
    add_recordings(options)
    add_model(options)
    add_effects(options)
    add_results(options)
    add_workers(options)
    return options


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    options = parser().parse_args(arguments)
    return run_command(lambda: _diagnose(options))


def _diagnose(options: argparse.Namespace) -> None:
    experiments, unseen = load_all(options)
    said = announce([*experiments, *unseen])
    label, model = chosen_model(options.model, [*experiments, *unseen])
    with executor(options.jobs, options.scheduler) as pool, progress_bar("diagnose") as progress:
        problem = Problem(experiments, pool)
        fit = fit_least_squares(problem, prepared(model, experiments), part(progress, "fit: ", 0.0, 0.3))
        found = diagnose(problem, fit, options.effects, part(progress, "diagnosis: ", 0.3, 0.95))
        comparison = compare(
            fit.model, experiments, pool, unseen, f"{label}, fitted", part(progress, "", 0.95, 1.0)
        )
    show([comparison], said)
    print(found)
    if options.json:
        write_json({**comparison.to_json(), **diagnosis_json(found)}, options.json)
    print(f"Wrote {write_report(diagnosis_content(found, comparison), options.output)}.")


if __name__ == "__main__":
    sys.exit(main())
