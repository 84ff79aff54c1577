# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Is anything missing? The largest of all scores against its distribution by noise alone (Westfall and Young 1993)."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from hasel_sysid.selection.likelihood import Whitened

_DRAWS = 500


@dataclass(frozen=True)
class ScoreTest:
    """chance: of a largest score like this by noise alone; gains: of the log-likelihood, by candidate; threshold: the
    gain that noise alone exceeds with the chance of the level.
    """

    chance: float
    gains: dict[str, float]
    threshold: float


def score_test(fitted: Whitened, columns: Sequence[tuple[str, np.ndarray]], level: float) -> ScoreTest:
    """Test a model against all candidates at once; the chance is of the maximum, so that many of them cost nothing.

    columns: of candidates, by name, whitened [frames, n], size and sign left open.
    """
    gains: dict[str, float] = {}
    largest = np.zeros(_DRAWS)
    draws = fitted.beyond(_white(len(fitted.residual)))
    for name, own in columns:
        directions = _directions(fitted, own)
        gain = 0.5 * float(((directions.T @ fitted.residual) ** 2).sum())
        gains[name] = max(gain, gains.get(name, 0.0))
        largest = np.maximum(largest, 0.5 * ((directions.T @ draws) ** 2).sum(axis=0))
    if not gains:
        return ScoreTest(1.0, gains, 0.0)
    chance = float((1 + np.sum(largest >= max(gains.values()))) / (1 + _DRAWS))
    return ScoreTest(chance, gains, float(np.quantile(largest, 1 - level)))


def _directions(fitted: Whitened, columns: np.ndarray) -> np.ndarray:
    """Orthonormal directions [frames, n] of what columns do and the fitted parameters cannot."""
    size = np.linalg.norm(columns, axis=0)
    left = fitted.beyond(columns)
    power = np.linalg.norm(left, axis=0)
    seen = power > 1e-6 * np.where(size > 0, size, 1.0)
    basis, strength, _ = np.linalg.svd(left[:, seen] / power[seen], full_matrices=False)
    return basis[:, strength > 1e-6 * strength[:1].sum()]


@lru_cache(maxsize=1)
def _white(frames: int) -> np.ndarray:
    """Noise of variance one, [frames, draws]; the same for every model that is tested."""
    return np.random.default_rng(0).standard_normal((frames, _DRAWS))
