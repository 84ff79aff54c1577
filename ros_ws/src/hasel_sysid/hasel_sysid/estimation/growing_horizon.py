# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Growing horizons against cycle skipping (Bunks et al. 1995): the first swing of every run, then two, four and so on.

A wrong frequency puts a model out of phase within a few swings; no derivative leads back from there.
"""

from dataclasses import replace

import numpy as np

from hasel_sysid.experiment import Experiment
from hasel_sysid.problem import Evaluation, Problem
from hasel_sysid.residual_analysis.drive_cycle import drive_cycle
from hasel_sysid.residual_analysis.swing import fit_swing

_OUT_OF_PHASE = 0.5
"""A model that leaves this share of the measured power moves against the body in part of the time."""
_FEWEST_FRAMES = 12
_SHORTEST_SHARE, _LONGEST_SHARE = 1 / 64, 0.6
"""Of a run; a horizon of more than that is the run itself."""


def in_phase(evaluation: Evaluation) -> bool:
    """Whether a model moves with the body: it leaves less than half of the power of what was measured."""
    measured = evaluation.measured()
    return evaluation.sum_of_squares < _OUT_OF_PHASE * float(measured @ measured)


def horizons(problem: Problem) -> list[Problem]:
    """The problem with one swing of every run, two, four and so on, all frames last.

    A swing is what the body does in one period of its own after it was let go, or in half a period of the drive.
    """
    swings = [_first_swing(experiment) for experiment in problem.experiments]
    found, times = [], 1
    while any(
        times * s < _LONGEST_SHARE * _duration(e) for s, e in zip(swings, problem.experiments, strict=True)
    ):
        short = [_first(e, times * s) for s, e in zip(swings, problem.experiments, strict=True)]
        found.append(problem.with_experiments(short))
        times *= 2
    return [*found, problem]


def length(problem: Problem) -> float:
    """Of the longest run [s]."""
    return max(_duration(experiment) for experiment in problem.experiments)


def _duration(experiment: Experiment) -> float:
    return float(experiment.run.time[-1] - experiment.run.start)


def _first(experiment: Experiment, duration: float) -> Experiment:
    run = experiment.run
    count = int(np.searchsorted(run.time, run.start + duration, side="right"))
    first = int(np.searchsorted(run.time, run.start))
    count = min(max(count, first + _FEWEST_FRAMES), len(run.time))
    return replace(experiment, run=replace(run, time=run.time[:count]))


def _first_swing(experiment: Experiment) -> float:
    """How long the first swing takes [s], measured."""
    run, whole = experiment.run, _duration(experiment)
    if run.schedule is not None:
        cycle = drive_cycle(run.time, run.schedule.at(run.time))
        swing = whole if cycle is None else 0.5 * cycle.period
    else:
        first = experiment.outputs[:, 0]
        used = (run.time >= run.start) & np.isfinite(first)
        found = fit_swing(run.time[used], first[used])
        swing = whole if found is None else 1.0 / found.frequency
    return float(np.clip(swing, _SHORTEST_SHARE * whole, whole))
