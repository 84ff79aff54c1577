# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Added mass: the fluid that the body carries along."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState


class AddedMass(ForceEffect):
    """Inertia of the surrounding fluid on the skin's normal acceleration."""

    id = "added_mass"
    physics = (
        "Accelerating the skin accelerates the fluid before it, as if the skin were heavier along its normal."
    )
    equation = "f = -m_a (a.n) n per skin length and depth, n its present normal"
    parameters = (
        EffectParameter(
            "added_mass",
            "m_a",
            "kg/m^2",
            0.0,
            0.0,
            40.0,
            0.5,
            "C_m rho pi H^2 / 4 of a plate, C_m = 1-1.5, halved over its two sides: 10-30 in oil",
            usual=(10.0, 30.0),
        ),
    )
    signature = "Every resonance drops by one factor; the phase falls behind most near resonance."
    confused_with = ("soft_modulus", "payload", "spine_modulus")
    separated_by = (
        "Ring-down in air and in oil on the same day; a static deflection is not changed by added mass."
    )
    citation = "Newman, Marine Hydrodynamics (1977), section 4.15"
    sites = "skin"
    depends_on = ("acceleration", "tangent")

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per skin length [N/m^2], [n, 2]."""
        normal = at.normal
        across = at.acceleration[:, 0] * normal[:, 0] + at.acceleration[:, 1] * normal[:, 1]
        return -p.added_mass * across[:, None] * normal
