"""What "explained" means, once for terminal, files, report and node: a share of the mean error above the noise."""

from enum import Enum

import numpy as np

from hasel_sysid.noise import NoiseModel
from hasel_sysid.policy import POLICY


def share_left(before: float, after: float, noise: float) -> float:
    """Share, 0 to 1, of a mean |Δ sin θ| above the noise that another one leaves; noise: its own mean |Δ sin θ|.

    Of the mean |Δ sin θ|, not of its square, which would call a law of the wrong shape an explanation.
    """
    floor = (1 + POLICY.noise_known) * noise
    return float(np.clip((after - floor) / max(before - floor, 1e-12), 0.0, 1.0))


def near_noise(error: float, noise: NoiseModel) -> bool:
    """Whether a mean |Δ sin θ| is as small as the noise, as far as that is known."""
    return error <= POLICY.near_noise * noise.mean_absolute


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
    if describes and (nothing_else or left <= POLICY.matters):
        return Status.EXPLAINED
    return Status.PARTLY_EXPLAINED if left <= 1 - POLICY.part else Status.UNEXPLAINED
