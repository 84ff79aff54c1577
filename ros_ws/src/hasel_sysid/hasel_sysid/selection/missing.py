"""Is anything missing? The largest of all scores against what noise alone makes of it."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from hasel_sysid.selection.likelihood import Likelihood, Whitened

_DRAWS = 500


@dataclass(frozen=True)
class Missing:
    """chance: of a largest score like this by noise alone; gains: by effect, of the logarithm of the likelihood;
    threshold: the gain that noise alone exceeds with the chance of the level.
    """

    chance: float
    gains: dict[str, float]
    threshold: float


def missing(
    fitted: Whitened, looks: Mapping[str, np.ndarray], likelihood: Likelihood, level: float, seed: int = 0
) -> Missing:
    """Test a fitted set against all effects at once; the chance is of the maximum, so that many effects cost nothing.

    looks [frames, n] of every effect that is not in the set.
    """
    found = likelihood.gains(fitted, looks.values())
    gains = {effect: look.gain for effect, look in zip(looks, found, strict=True)}
    if not gains:
        return Missing(1.0, gains, 0.0)
    draws = _white(len(fitted.residual), seed)
    draws = draws - fitted.basis @ (fitted.basis.T @ draws)
    largest = np.max([look.by(draws) for look in found], axis=0)
    chance = float((1 + np.sum(largest >= max(gains.values()))) / (1 + _DRAWS))
    return Missing(chance, gains, float(np.quantile(largest, 1 - level)))


@lru_cache(maxsize=1)
def _white(frames: int, seed: int) -> np.ndarray:
    """Noise of variance one, [frames, draws]; the same for every set that is tested."""
    return np.random.default_rng(seed).standard_normal((frames, _DRAWS))
