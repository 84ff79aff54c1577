"""What "explained" means, once for terminal, files, report and node: a share of the mean error above the noise."""

from enum import Enum

import numpy as np

EXPLAINED = 0.9
"""Share of the error above the noise that effects must remove to be an explanation."""
PARTLY = 0.6
"""Share that they must remove to be part of one."""
NOISE = 1.05
"""A mean error up to this many times the noise's is noise."""
NEAR_NOISE = 1.25
"""Correlated noise of nine runs is known to 8 %: a mean error within three times that of the noise's is near it."""


def share_left(before: float, after: float, noise: float) -> float:
    """Share, 0 to 1, of a mean |Δ sin θ| above the noise that another one leaves; noise: its own mean |Δ sin θ|.

    Of the mean |Δ sin θ|, not of its square, which would call a law of the wrong shape an explanation.
    """
    floor = NOISE * noise
    return float(np.clip((after - floor) / max(before - floor, 1e-12), 0.0, 1.0))


class Status(str, Enum):
    """What a search for missing effects comes to."""

    NOTHING_MISSING = "nothing_missing"
    EXPLAINED = "explained"
    PARTLY_EXPLAINED = "partly_explained"
    UNEXPLAINED = "unexplained"


def status_with(left: float, describes: bool, nothing_else: bool = False) -> Status:
    """The status of effects that leave this share of the mean error above the noise.

    describes: whether the model with them describes its runs to the noise, without which nothing is explained;
    nothing_else: whether what they leave looks like noise.
    """
    if describes and (nothing_else or left <= 1 - EXPLAINED):
        return Status.EXPLAINED
    return Status.PARTLY_EXPLAINED if left <= 1 - PARTLY else Status.UNEXPLAINED
