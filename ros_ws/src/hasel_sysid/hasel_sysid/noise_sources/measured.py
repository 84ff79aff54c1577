"""The noise as measured or as given; never as what a model fails to explain."""

from collections.abc import Sequence

import numpy as np

from hasel_sysid.dataset import Experiment
from hasel_sysid.errors import SysidError
from hasel_sysid.noise import NoiseModel, estimate_noise
from hasel_sysid.noise_sources.repeated_runs import differences_of_repeats
from hasel_sysid.noise_sources.rest_frames import rest_stretches


def measured_noise(experiments: Sequence[Experiment]) -> NoiseModel | None:
    """The noise between repeated runs, else at rest; None where these recordings show neither."""
    repeats = differences_of_repeats(experiments)
    if repeats:
        return _of(repeats, f"differences between {len(repeats)} pair(s) of repeated runs")
    rests = rest_stretches(experiments)
    frames = sum(map(len, rests))
    return _of(rests, f"{frames} frames at rest") if rests else None


def given_noise(standard_deviation: float) -> NoiseModel:
    """White noise of a known standard deviation of sin theta. Raises SysidError unless it is positive."""
    if not (np.isfinite(standard_deviation) and standard_deviation > 0):
        raise SysidError(
            f"the noise is given as {standard_deviation:g}; expected a standard deviation of sin θ above 0, "
            "such as 0.003"
        )
    return NoiseModel(standard_deviation**2, 0.0, 0.5, "as given")


def _of(stretches: Sequence[np.ndarray], source: str) -> NoiseModel:
    runs = np.repeat(np.arange(len(stretches)), [len(s) for s in stretches])
    means = (runs[:, None] == np.arange(len(stretches))).astype(float)
    return estimate_noise(np.concatenate(stretches), runs, means, source)
