# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""How much work a simulation is, each stage usually is in simulations of all runs by the fitted model; a time limit.

By recorded searches (`test/timings/improve.csv`): about the middle of what a stage took; of the rare ones some more,
as strong effects take longer per simulation. `chance` is about how often a stage comes in use: what is recorded holds
more of the long searches, which take three to six times as long as the others.
"""

import math
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TypeVar

from hasel_common.progress import Stage
from hasel_sim.model import Model
from hasel_sim.run import Run

Work = TypeVar("Work")
START = Stage("start", 1.0, known=True)
FIT = Stage("fit", 15.0)
SET_UP = Stage("faults of the set-up", 28.0, chance=0.4)
BEGINNINGS = Stage("first of the beginning of every run")
TYPICAL = Stage("every effect at its typical size", 24.0)
ALONE = Stage("every effect alone", 36.0, chance=0.6)
OTHER_SIZES = Stage("every effect alone, from all other sizes", 110.0, chance=0.15)
NUMBERS = Stage("every number of the model file", 8.0, chance=0.13)
NUMBERS_ALONE = Stage("every number of the model file alone", 20.0, chance=0.13)
NUMBERS_OTHER_SIZES = Stage("every number of the model file alone, from all other sizes", 130.0, chance=0.13)
ROUND = Stage("effects beside each other", 80.0, chance=0.13)
SET_UP_BESIDE = Stage("faults of the set-up beside them", 18.0, chance=0.02)
ENDING = Stage("the answer by finer numerics", 8.0, chance=0.4)
COMPARISON = Stage("comparison", 1.0, known=True)
NEXT_RUNS = Stage("the next runs", 10.0, chance=0.02)

_DERIVATIVE = 0.5
"""Time that a derivative takes, of that of a simulation without any."""
USUAL_SPEED = 20_000.0
"""Work per second (`work_of`) that is expected before any is measured: of two processes with a core each."""

_CANDIDATES = 31
"""Effects of the catalogue beside the swimmer, by which the stages of a search were measured."""
_SEARCH = (TYPICAL, ALONE, OTHER_SIZES)
_NUMBERS = (NUMBERS, NUMBERS_ALONE, NUMBERS_OTHER_SIZES)
_BATCH = 8


def work_of(model: Model, runs: Sequence[Run], derivatives: int = 0) -> float:
    """Of simulating runs with so many derivatives, in proportion to the time that it takes: elements times steps."""
    numerics = model.description.numerics
    duration_s = sum(float(run.time[-1] - run.start) for run in runs)
    return numerics.mesh_density * numerics.steps_per_second * duration_s * (1.0 + _DERIVATIVE * derivatives)


def plan_of_fit(size: float) -> list[Stage]:
    """The stages of a fit. size: work of one simulation of all runs (`work_of`)."""
    return _times(size, [FIT, COMPARISON])


def plan_of_search(size: float, candidates: int) -> list[Stage]:
    """The stages of a search among so many effects for what a fitted model lacks; size: as of a fit."""
    return _times(size * candidates / _CANDIDATES, [*_SEARCH, ROUND])


def plan_of_diagnosis(size: float, candidates: int) -> list[Stage]:
    """The stages of a fit and a diagnosis among so many effects; size: as of a fit."""
    first, last = plan_of_fit(size)
    return [first, *plan_of_search(size, candidates), last]


def plan_of_improve(size: float, candidates: int) -> list[Stage]:
    """The stages of `improve` among so many effects; size: as of a fit."""
    search = _times(size * candidates / _CANDIDATES, [*_SEARCH, *_NUMBERS, ROUND])
    return [*_times(size, [START, FIT, SET_UP]), *search, *_times(size, [SET_UP_BESIDE, ENDING, NEXT_RUNS])]


def plan_of_next_runs(size: float) -> list[Stage]:
    """The stage that looks for the runs that tell apart what a diagnosis left in doubt; size: as of a fit."""
    return _times(size, [replace(NEXT_RUNS, chance=1.0)])


def plan_of_suggest(size: float, candidates: int) -> list[Stage]:
    """The stages of a diagnosis, and of the runs that tell apart what it leaves in doubt; size: as of a fit."""
    return [*plan_of_diagnosis(size, candidates)[:-1], *plan_of_next_runs(size)]


def _times(size: float, stages: Sequence[Stage]) -> list[Stage]:
    return [replace(stage, work=stage.work * size) for stage in stages]


class TimeLimit:
    """From its making. `is_over` is asked before each piece of work that could be left out; none is broken off."""

    def __init__(self, seconds: float = math.inf, clock: Callable[[], float] = time.monotonic) -> None:
        """clock: what tells the time, in seconds."""
        self.seconds, self._clock = seconds, clock
        self._began = clock()
        self.left_something_out = False

    def is_over(self) -> bool:
        """Whether so many seconds have gone by; who is told so leaves its work out, which is remembered."""
        over = self._clock() - self._began > self.seconds
        self.left_something_out |= over
        return over

    def in_batches(self, pieces: Sequence[Work], even_late: bool = False) -> Iterator[Sequence[Work]]:
        """Eight pieces of work at a time, to be done side by side, until time is over; even_late: the first eight in
        any case.
        """
        for begin in range(0, len(pieces), _BATCH):
            if not (even_late and begin == 0) and self.is_over():
                return
            yield pieces[begin : begin + _BATCH]

    def __str__(self) -> str:
        return f"the limit of {self.seconds:g} s"
