# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Added mass of a body of finite depth: the fluid that goes around its edges and ends."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState
from hasel_sim.effects.slender import LineMotion, finite_length_factor, growth_of_momentum, strip_added_mass


class FiniteDepthAddedMass(ForceEffect):
    """Inertia of the fluid across the centre line, from the body's own depth and length.

    The equation of motion that follows from the fluid's energy m w^2 / 2 (Kirchhoff): what the body spends the fluid
    has, and gives back.
    """

    id = "finite_depth_added_mass"
    physics = (
        "A body carries fluid along as it swings, the more the deeper it is, less what escapes around its ends; it "
        "keeps what it carries, and leaves none behind."
    )
    equation = (
        "f = -d(m w n)/dt + d(m u w n)/ds with nothing shed at the tail, m = C_m (rho pi H / 4) / E(e) per length of "
        "the centre line and depth H, u = v.t, w = v.n, e^2 = 1 - (H / L)^2, E the complete elliptic integral"
    )
    parameters = (
        EffectParameter(
            "coefficient",
            "C_m",
            "1",
            0.0,
            0.0,
            2.0,
            1.0,
            "1 of an elliptic plate without viscosity (Lamb 1932), 1.2-1.5 with the oscillating layer at 0.5-2.5 Hz",
            usual=(1.0, 1.5),
        ),
    )
    signature = "Every resonance drops by one factor; the phase falls behind most near resonance."
    confused_with = ("added_mass", "reactive_force", "soft_modulus", "payload", "spine_modulus")
    separated_by = "Ring-down in air and in the fluid on the same day; a static deflection is not changed."
    citation = "Lamb, Hydrodynamics, 6th ed. (1932), sections 71, 114 and 124"
    needs_medium = True
    exclusive = "inertia of the fluid"
    sites = "line"
    sheds = False
    depends_on = ("velocity", "acceleration", "tangent", "tangent_rate")

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """What the growth of the fluid's momentum takes, per length and depth [N/m^2], [n, 2]."""
        return -self._mass(at, p) * growth_of_momentum(at)

    def flux(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Momentum that is handed on as the body slips through, per depth [N/m], [n, 2]."""
        motion = LineMotion.at(at)
        return self._mass(at, p) * (motion.along * motion.across)[:, None] * motion.normal

    def _mass(self, at: SiteState, p: SimpleNamespace) -> float:
        return p.coefficient * strip_added_mass(at.fluid) * finite_length_factor(at.fluid)
