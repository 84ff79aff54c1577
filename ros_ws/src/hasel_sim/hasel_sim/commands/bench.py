# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`bench`: speed of everything, of effects or of swims beside its bars, against another revision, or convergence."""

import argparse
import json
import sys

from rich.console import Console
from threadpoolctl import threadpool_limits

from hasel_sim.bench.cases import first_run_seconds, fitted_swimmer, shares
from hasel_sim.bench.convergence import ConvergenceReport, mesh_errors, step_errors
from hasel_sim.bench.effect_costs import EffectsReport, measure_effects
from hasel_sim.bench.in_turns import InTurns, measure_in_turns
from hasel_sim.bench.speed import (
    SpeedReport,
    SwimmingReport,
    by_nodes,
    by_parameters,
    free_swim_factor,
    measure_side_by_side,
    measure_swimming,
)
from hasel_sim.errors import HaselSimError

SIZES = (180, 275, 700, 1400)
"""Wanted nodes: the second is the default mesh, the last has as many as the simulator this one is compared with."""


def measure_speeds(console: Console) -> SpeedReport:
    """Everything about speed, saying what is under way."""
    with console.status("compiling as on a first run"):
        first_run = first_run_seconds()
    with console.status("timing four meshes"):
        sizes, slope = by_nodes(SIZES)
    with console.status("timing against the number of parameters"):
        parameters = by_parameters()
    with console.status("timing runs side by side"):
        lanes = measure_side_by_side(fitted_swimmer())
    with console.status("timing a free swim"):
        swim = free_swim_factor()
    return SpeedReport(
        first_run, sizes, sizes[1], sizes[-1], slope, parameters, lanes, shares(fitted_swimmer()), swim
    )


def run(options: argparse.Namespace) -> int:
    """Print the tables; 0 when every bar is met, else 1."""
    console = Console()
    report: ConvergenceReport | EffectsReport | InTurns | SwimmingReport | SpeedReport
    with threadpool_limits(1):
        if options.convergence:
            report = ConvergenceReport(mesh_errors(), step_errors())
        elif options.against:
            try:
                with console.status("timing two versions in turns"):
                    report = measure_in_turns(options.against)
            except HaselSimError as error:
                print(error, file=sys.stderr)
                return 1
        elif options.effects:
            with console.status("timing every effect"):
                report = measure_effects()
        elif options.swimming:
            with console.status("timing swims"):
                report = measure_swimming()
        else:
            report = measure_speeds(console)
    report.print(console)
    if options.json:
        options.json.write_text(json.dumps(report.values(), indent=1))
    return int(
        not isinstance(report, ConvergenceReport | InTurns) and not all(bar.met for bar in report.bars())
    )
