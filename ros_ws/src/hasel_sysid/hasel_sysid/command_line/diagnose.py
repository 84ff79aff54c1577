# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`diagnose RECORDING…`: rank the missing effects, with a verdict each."""

import argparse
import sys
from collections.abc import Sequence

from hasel_common.progress import progress_bar

from hasel_sysid.answer.diagnosis import diagnosis_json
from hasel_sysid.candidates import effects_of
from hasel_sysid.command_line.inputs import load_inputs, that_can_be_simulated
from hasel_sysid.command_line.options import diagnose_parser
from hasel_sysid.command_line.running import told, workers, write_json
from hasel_sysid.command_line.shown import code_after, show, summarise, tell
from hasel_sysid.command_line.summary import diagnosis_lines
from hasel_sysid.comparison import compare
from hasel_sysid.estimation import fit_baseline
from hasel_sysid.expected_work import COMPARISON, USUAL_SPEED, TimeLimit, plan_of_diagnosis, work_of
from hasel_sysid.improvement import diagnose
from hasel_sysid.problem import Problem
from hasel_sysid.report.from_improvement import diagnosis_content
from hasel_sysid.report.pictures import vector_figures
from hasel_sysid.report.write import write_report


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return run(diagnose_parser().parse_args(arguments))


@told
def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    given, limit = load_inputs(options), TimeLimit(options.seconds)
    size = work_of(given.model, [each.run for each in given.experiments])
    plan = plan_of_diagnosis(size, len(effects_of(given.model, options.effects)))
    with workers(options) as pool, progress_bar("diagnose", plan, usual_speed=USUAL_SPEED) as work:
        given = that_can_be_simulated(given, pool)
        problem = Problem(given.experiments, pool, given.noise, limit, work)
        fit = fit_baseline(problem, given.model)
        found = diagnose(problem, fit, options.effects)
        label = f"{given.label}, fitted"
        with problem.workload.stage(COMPARISON):
            comparison = compare(fit.model, given.experiments, pool, given.unseen, label, work)
    tell(comparison.set_up, given.said)

    def everything() -> None:
        show([comparison], [*given.said, *comparison.set_up])
        print(found)

    others = f"tables of all runs, where the model fails, all {len(found.findings)} effects"
    summarise(diagnosis_lines(found, comparison), everything, options.all, others)
    if options.json:
        write_json({**comparison.to_json(), **diagnosis_json(found)}, options.json)
    content = diagnosis_content(found, comparison)
    report = write_report(content, options.output)
    vector_figures(content, options.output)
    print(f"Wrote {report}, and its figures as SVG.")
    return code_after(comparison.set_up)


if __name__ == "__main__":
    sys.exit(main())
