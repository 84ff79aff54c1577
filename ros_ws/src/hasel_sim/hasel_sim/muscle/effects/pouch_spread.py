# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Pouch spread: the pouches of a muscle are not filled alike."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter
from hasel_sim.muscle.effect import MuscleEffect
from hasel_sim.muscle.pouch import Pouch

_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(5)


class PouchSpread(MuscleEffect):
    """Fills are spread log-normally about the nominal one; the pouches are in series under the same force."""

    id = "pouch_spread"
    physics = "Hand-filled pouches differ: those with less liquid zip first, so that the onset is not sharp."
    equation = "x = mean of x(fill exp(s z)), z normal (5 Gauss-Hermite nodes)"
    parameters = (
        EffectParameter(
            "spread", "s", "1", 0.0, 0.0, 0.8, 0.2, "filling by syringe: some 10 to 50 % (estimate)"
        ),
    )
    signature = "A soft onset: some contraction below the voltage at which equal pouches begin, less than theirs above."
    citation = "Abramowitz and Stegun, Handbook of Mathematical Functions (1964), 25.4.46 (quadrature)"

    def pouches(self, pouch: Pouch, p: SimpleNamespace) -> list[tuple[float, Pouch]]:
        """Five kinds of pouches; no fuller than a pouch can be."""
        if p.spread == 0:
            return [(1.0, pouch)]
        fullest = 0.99 * pouch.largest_fill
        fills = np.minimum(pouch.fill * np.exp(p.spread * _NODES), fullest)
        shares = _WEIGHTS / _WEIGHTS.sum()
        return [
            (float(share), replace(pouch, fill=float(fill)))
            for share, fill in zip(shares, fills, strict=True)
        ]
