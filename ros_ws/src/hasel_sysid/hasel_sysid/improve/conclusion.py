"""What the stages of an improvement come to."""

from collections.abc import Sequence

import numpy as np

from hasel_sysid.diagnosis import Diagnosis
from hasel_sysid.diagnosis.context import SIGNIFICANT
from hasel_sysid.fit import FitResult
from hasel_sysid.improve.result import Improvement, Stage, Status

EXPLAINED = 0.9
"""Share of the baseline's error above the noise that accepted effects must remove to be an explanation."""
PARTLY = 0.6
"""Share that they must remove to be part of one."""
NOISE = 1.05
"""A mean error up to this many times the noise's is noise."""
NEAR_NOISE = 1.25
"""Correlated noise of nine runs is known to 8 %: a mean error within three times that of the noise's is near it."""
_ALL_BUT_NOTHING, _FEW = 0.03, 2
"""Of a large error this share is all but nothing, but only so many effects may leave it and still be an explanation:
three imitate much that is not listed."""


def last_diagnosis(stages: Sequence[Stage]) -> Diagnosis:
    """That of the last stage that was diagnosed."""
    return next(stage.diagnosis for stage in reversed(stages) if stage.diagnosis is not None)


def left_over(stages: Sequence[Stage]) -> float:
    """Share of the baseline's mean error above the noise that the last stage leaves, 0 to 1."""
    return share_left(stages[0].fit, stages[-1].fit, last_diagnosis(stages).noise.mean_absolute)


def share_left(before: FitResult, after: FitResult, noise: float) -> float:
    """Share of a fit's mean error above the noise that another fit leaves, 0 to 1.

    Of the mean |Δ sin θ|, not of its square, which would call a law of the wrong shape an explanation. noise: its mean
    |Δ sin θ|.
    """
    floor = NOISE * noise
    base, left = before.mean_absolute_error, after.mean_absolute_error
    return float(np.clip((left - floor) / max(base - floor, 1e-12), 0.0, 1.0))


def is_noise(fit: FitResult, found: Diagnosis) -> bool:
    """Whether what a fit leaves is no more than the noise."""
    return fit.mean_absolute_error <= NOISE * found.noise.mean_absolute


def near_noise(fit: FitResult, found: Diagnosis) -> bool:
    """Whether what a fit leaves is as small as the noise, as far as that is known."""
    return fit.mean_absolute_error <= NEAR_NOISE * found.noise.mean_absolute


def conclude(
    stages: Sequence[Stage], reason: str, negligible: bool = False, contradictions: Sequence[str] = ()
) -> Improvement:
    """The verdict on all stages, baseline first.

    reason: why the last one is the last; negligible: whether all that could be added would hardly matter;
    contradictions: what speaks against the effects that were added, whatever they explain.
    """
    first = stages[0].diagnosis
    last = last_diagnosis(stages)
    unexplained = left_over(stages)
    added = stages[-1].effects
    rest = stages[-1].diagnosis
    nothing_left = negligible or (rest is not None and rest.p_value >= SIGNIFICANT)
    nearly_all = len(added) <= _FEW and unexplained <= _ALL_BUT_NOTHING
    near = near_noise(stages[-1].fit, last) or nearly_all
    if first.p_value >= SIGNIFICANT:
        status, unexplained = Status.NOTHING_MISSING, 0.0
    elif not added:
        status = Status.NOTHING_MISSING if negligible else Status.UNEXPLAINED
    elif nothing_left or (near and unexplained <= 1 - EXPLAINED):
        status = Status.PARTLY_EXPLAINED if contradictions else Status.EXPLAINED
    else:
        status = Status.PARTLY_EXPLAINED if unexplained <= 1 - PARTLY else Status.UNEXPLAINED
    missing = added if status in (Status.EXPLAINED, Status.PARTLY_EXPLAINED) else ()
    return Improvement(
        list(stages), status, missing, unexplained, last.noise.mean_absolute, reason, tuple(contradictions)
    )
