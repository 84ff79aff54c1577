"""What the stages of an improvement come to."""

from collections.abc import Sequence

import numpy as np

from hasel_sysid.diagnosis.judgement import SIGNIFICANT
from hasel_sysid.improve.result import Improvement, Stage, Status

EXPLAINED = 0.9
"""Share of the baseline's error above the noise that accepted effects must remove to be an explanation."""
_PARTLY = 0.6
NOISE = 1.05
"""A mean error up to this many times the noise's is noise."""
_NEAR_NOISE = 1.25
"""Where a last look still sees something, a mean error beyond this many times the noise's is not explained."""


def left_over(stages: Sequence[Stage]) -> float:
    """Share of the baseline's mean error above the noise that the last stage leaves, 0 to 1.

    Of the mean |Δ sin θ|, not of its square, which would call a law of the wrong shape an explanation.
    """
    found = next(stage.diagnosis for stage in reversed(stages) if stage.diagnosis is not None)
    base, left = (stage.fit.mean_absolute_error for stage in (stages[0], stages[-1]))
    floor = NOISE * found.noise.mean_absolute
    return float(np.clip((left - floor) / max(base - floor, 1e-12), 0.0, 1.0))


def conclude(stages: Sequence[Stage], reason: str, negligible: bool = False) -> Improvement:
    """The verdict on all stages, baseline first.

    reason: why the last one is the last; negligible: whether all that could be added would hardly matter.
    """
    first = stages[0].diagnosis
    last = next(stage.diagnosis for stage in reversed(stages) if stage.diagnosis is not None)
    unexplained = left_over(stages)
    added = stages[-1].effects
    rest = stages[-1].diagnosis
    nothing_left = negligible or (rest is not None and rest.p_value >= SIGNIFICANT)
    near = rest is None or stages[-1].fit.mean_absolute_error <= _NEAR_NOISE * rest.noise.mean_absolute
    if first.p_value >= SIGNIFICANT:
        status, unexplained = Status.NOTHING_MISSING, 0.0
    elif not added:
        status = Status.NOTHING_MISSING if negligible else Status.UNEXPLAINED
    elif nothing_left or (near and unexplained <= 1 - EXPLAINED):
        status = Status.EXPLAINED
    else:
        status = Status.PARTLY_EXPLAINED if unexplained <= 1 - _PARTLY else Status.UNEXPLAINED
    missing = added if status in (Status.EXPLAINED, Status.PARTLY_EXPLAINED) else ()
    return Improvement(list(stages), status, missing, unexplained, last.noise.mean_absolute, reason)
