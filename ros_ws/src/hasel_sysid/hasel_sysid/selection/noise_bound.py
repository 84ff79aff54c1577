"""Noise where nothing shows it alone: as slow as it looks beside the best fit, and no louder than any bound."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hasel_sysid.diagnosis.learned_residual import regressors, unexplained_by
from hasel_sysid.noise import NoiseModel, estimate_noise
from hasel_sysid.noise_sources.above_the_band import noise_above_the_band
from hasel_sysid.noise_sources.between_periods import noise_between_periods
from hasel_sysid.problem import Evaluation


def bounded_noise(fits: Sequence[Evaluation]) -> NoiseModel:
    """From what the best of these fits leaves, what differs between periods, and what is faster than the body moves."""
    best = min(fits, key=lambda e: e.sum_of_squares)
    columns = np.column_stack([best.jacobian, regressors(best)])
    looks = estimate_noise(
        unexplained_by(columns, best.residual), best.runs, columns, "what the best set leaves"
    )
    others = [noise_between_periods(best), noise_above_the_band(best)]
    bounds = [b.standard_deviation for b in others if b] + [looks.standard_deviation]
    share = (min(bounds) / looks.standard_deviation) ** 2
    return replace(looks, white=share * looks.white, coloured=share * looks.coloured, upper_bound=True)
