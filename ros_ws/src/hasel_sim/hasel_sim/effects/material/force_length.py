# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Force-length weakening: a contracted muscle pulls less."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, MaterialEffect, MaterialPoints
from hasel_sim.mesh.mesh import Region

REFERENCE_STRAIN = 0.1


class ForceLength(MaterialEffect):
    """Falling force-strain curve of a zipping pouch."""

    id = "force_length"
    physics = "A Peano-HASEL's force falls with its own shortening, so its fibres weaken as they contract."
    equation = "w <- w (1 - k eps / eps_0), eps = 1 - abs(F m), eps_0 = 0.1"
    parameters = (
        EffectParameter(
            "weakening",
            "k",
            "1",
            0.0,
            0.0,
            1.0,
            0.5,
            "zipping model: force falls 16-fold from 20 to 60 degrees of pouch angle",
        ),
    )
    signature = (
        "Third harmonic; the highest voltage is over-predicted; stiffness depends on how far the muscle is "
        "switched on."
    )
    confused_with = ("spine_stiffening", "antagonist_slack")
    separated_by = (
        "Isometric force at three lengths and three voltages; ring-down with the muscle held on and off."
    )
    citation = "Kellaris, Gopaluni Venkata, Rothemund, Keplinger, Extreme Mechanics Letters 29 (2019) 100449"
    needs_muscles = True
    regions = (Region.UPPER_MUSCLE, Region.LOWER_MUSCLE)

    def first_piola(self, at: MaterialPoints, p: SimpleNamespace) -> np.ndarray:
        """What the weaker fibre pulls less [Pa], [n, 2, 2]."""
        shortening = 1.0 - at.stretch
        tension = at.fibre * (at.stretch - (1.0 - at.contraction))
        return at.along_fibre(-p.weakening * shortening / REFERENCE_STRAIN * tension)
