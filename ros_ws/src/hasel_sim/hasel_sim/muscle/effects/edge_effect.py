# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Edge effect: near its side seals a pouch cannot become a cylinder."""

from dataclasses import replace
from types import SimpleNamespace

from hasel_sim.effects.base import EffectParameter
from hasel_sim.muscle.effect import MuscleEffect
from hasel_sim.muscle.pouch import Pouch


class EdgeEffect(MuscleEffect):
    """A strip along each side seal, as wide as a share of the pouch's length, does not pull."""

    id = "edge_effect"
    physics = (
        "The side seals keep the films together, so that strips beside them neither bulge nor pull; narrow "
        "pouches lose most."
    )
    equation = "w_eff = w - 2 kappa L_p"
    parameters = (
        EffectParameter(
            "strip", "kappa", "1", 0.0, 0.0, 1.0, 0.3, "up to one pouch length on each side (estimate)"
        ),
    )
    signature = (
        "Less force by one factor at all voltages and strains; the factor falls as pouches get narrower."
    )
    citation = (
        "Kellaris, Gopaluni Venkata, Rothemund, Keplinger, Extreme Mechanics Letters 29 (2019) 100449 "
        "(narrow pouches stay below the model)"
    )

    def pouches(self, pouch: Pouch, p: SimpleNamespace) -> list[tuple[float, Pouch]]:
        """The pouch without its dead strips; a hundredth of the width is left at least."""
        width = max(pouch.width - 2 * p.strip * pouch.film_length, 0.01 * pouch.width)
        return [(1.0, replace(pouch, width=width))]
