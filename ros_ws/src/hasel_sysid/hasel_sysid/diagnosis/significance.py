"""Could noise alone look like this? Thresholds on the largest of all candidates' scores, under correlated noise."""

from collections.abc import Sequence

import numpy as np

from hasel_sysid.noise import NoiseModel
from hasel_sysid.projection import orthonormal

_DRAWS = 500


def drops(columns: np.ndarray, basis: np.ndarray, residual: np.ndarray) -> np.ndarray:
    """By how much columns [frames, n] lower a residual's sum of squares beyond what a basis [frames, m] already does.

    residual [frames] or [frames, draws]; returns one drop for each, [] or [draws].
    """
    directions = orthonormal(columns - basis @ (basis.T @ columns))
    return ((directions.T @ residual) ** 2).sum(axis=0)


def largest_drops_by_noise(
    fitted: np.ndarray, candidates: Sequence[np.ndarray], noise: NoiseModel, runs: np.ndarray, seed: int = 0
) -> np.ndarray:
    """How much the best candidate lowers the sum of squares when there is only noise, for many draws of the noise.

    fitted [frames, n]: derivatives of the fitted parameters; candidates: signatures [frames, 1 or more] of each effect,
    linearised. Returns one largest drop per draw.
    """
    basis = orthonormal(fitted)
    draws = noise.sample(runs, _DRAWS, np.random.default_rng(seed))
    draws -= basis @ (basis.T @ draws)
    largest = np.zeros(draws.shape[1])
    for columns in candidates:
        largest = np.maximum(largest, drops(columns, basis, draws))
    return largest


def p_value(drop: float, by_noise: np.ndarray) -> float:
    """Share of noise draws with at least this drop of the sum of squares (never exactly zero)."""
    return float((1 + np.sum(by_noise >= drop)) / (1 + len(by_noise)))
