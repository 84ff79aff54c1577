# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Reactive force: the fluid that a slender body throws sideways, and leaves behind at its tail."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState
from hasel_sim.effects.slender import LineMotion, growth_of_momentum, strip_added_mass


class ReactiveForce(ForceEffect):
    """Lighthill's large-amplitude theory of elongated bodies, as a force along the centre line.

    Fluid beside each piece has the momentum m w n. What the body gives to it is minus the force; it is handed on as the
    body slips through, and shed at the tail. Summed over the body this is Lighthill's balance, with the suction at the
    nose that an attached flow has there.
    """

    id = "reactive_force"
    physics = (
        "Each piece of the body gives sideways momentum to the fluid beside it, hands it on towards the tail as it "
        "slips through, and sheds it there: inertia, and thrust."
    )
    equation = (
        "f = -d(m w n)/dt + d(m u w n - 1/2 m w^2 t)/ds, m = C_m rho pi H / 4 per length of the centre line and depth "
        "H, u = v.t, w = v.n; (m u w n - 1/2 m w^2 t) at the tail is the sum"
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
            "1 of a slender body (Lighthill 1971), up to 1.5 where the oscillating layer is thick",
        ),
    )
    signature = "Resonances drop by one factor; thrust of a wave, most where the tail swings most."
    confused_with = ("added_mass", "finite_depth_added_mass", "soft_modulus", "payload")
    separated_by = (
        "Ring-down in air and in the fluid gives the inertia; a swimmer let go and one held tell the thrust."
    )
    citation = (
        "Lighthill, Proceedings of the Royal Society B 179 (1971) 125; Candelier, Boyer and Leroyer, Journal of Fluid "
        "Mechanics 674 (2011) 196"
    )
    needs_medium = True
    exclusive = "inertia of the fluid"
    sites = "line"
    depends_on = ("velocity", "acceleration", "tangent", "tangent_rate")

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """What the growth of the fluid's momentum takes, per length and depth [N/m^2], [n, 2]."""
        return -p.coefficient * strip_added_mass(at.fluid) * growth_of_momentum(at)

    def flux(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Momentum that is handed on, and the pressure of the flow across, per depth [N/m], [n, 2]."""
        motion = LineMotion.at(at)
        moved = (motion.along * motion.across)[:, None] * motion.normal
        pressed = (0.5 * motion.across**2)[:, None] * motion.tangent
        return p.coefficient * strip_added_mass(at.fluid) * (moved - pressed)
