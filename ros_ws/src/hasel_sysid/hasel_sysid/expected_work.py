"""How much work each stage usually is, for the time left; in simulations of all runs by the fitted model."""

from collections.abc import Sequence
from dataclasses import replace

from hasel_common.workload import Stage

START = Stage("start", 1.0, known=True)
FIT = Stage("fit", 15.0)
SET_UP = Stage("faults of the set-up", 5.0)
BEGINNINGS = Stage("first of the beginning of every run")
TYPICAL = Stage("every effect at its typical size", 25.0)
ALONE = Stage("every effect alone", 30.0, chance=0.8)
OTHER_SIZES = Stage("every effect alone, from all other sizes", 30.0, chance=0.3)
NUMBERS = Stage("every number of the model file", 5.0)
NUMBERS_ALONE = Stage("every number of the model file alone", 30.0)
NUMBERS_OTHER_SIZES = Stage("every number of the model file alone, from all other sizes", 30.0)
ROUNDS = Stage("effects beside each other", 30.0)
SET_UP_BESIDE = Stage("faults of the set-up beside them", 10.0)
ENDING = Stage("the answer by finer numerics", 10.0)
COMPARISON = Stage("comparison", 1.0, known=True)
NEXT_RUNS = Stage("the next runs", 10.0)

USUAL_SPEED = 1000.0
"""Work per second (`problem.work_of`) that is expected before any is measured: of two processes on a laptop."""

_CANDIDATES = 31
"""Effects of the catalogue beside the swimmer, by which the stages of a search were measured."""
_SEARCH = (TYPICAL, ALONE, OTHER_SIZES)
_NUMBERS = (NUMBERS, NUMBERS_ALONE, NUMBERS_OTHER_SIZES)


def plan_of_fit() -> list[Stage]:
    """The stages of a fit."""
    return [FIT, COMPARISON]


def plan_of_search(candidates: int) -> list[Stage]:
    """The stages of a search among so many effects, by the model of a fit."""
    return _of([*_SEARCH, ROUNDS], candidates)


def plan_of_diagnosis(candidates: int) -> list[Stage]:
    """The stages of a fit and a diagnosis among so many effects."""
    return [FIT, *plan_of_search(candidates), COMPARISON]


def plan_of_improve(candidates: int) -> list[Stage]:
    """The stages of `improve` among so many effects."""
    return [
        START,
        FIT,
        SET_UP,
        *_of([*_SEARCH, *_NUMBERS, ROUNDS], candidates),
        SET_UP_BESIDE,
        ENDING,
        NEXT_RUNS,
    ]


def plan_of_suggest(candidates: int) -> list[Stage]:
    """The stages of a diagnosis among so many effects, and of the runs that tell apart what it leaves in doubt."""
    return [*plan_of_diagnosis(candidates)[:-1], NEXT_RUNS]


def _of(stages: Sequence[Stage], candidates: int) -> list[Stage]:
    """Stages of a search among so many effects."""
    return [replace(stage, work=stage.work * candidates / _CANDIDATES) for stage in stages]
