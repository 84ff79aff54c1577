# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Skin friction: the laminar boundary layer that the body drags along."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState
from hasel_sim.effects.slender import LineMotion

BLASIUS = 1.328
"""Friction coefficient of one side of a plate times the root of its Reynolds number."""
TRIPLE_DECK = 2.67
"""What the plate's end adds to it, times the Reynolds number to the power 7/8; together right down to about 1."""


class SkinFriction(ForceEffect):
    """Friction of a laminar boundary layer along both sides, thinned by flow across the body."""

    id = "skin_friction"
    physics = (
        "A laminar boundary layer along both sides holds the body back; flow across the body makes the layer thinner "
        "and its friction larger."
    )
    equation = (
        "f = -rho sqrt((k_a C(Re) abs(u))^2 + k_b^2 nu abs(w) / H) u t per length of the centre line and depth H, "
        "u = v.t, w = v.n, Re = abs(u) L / nu, C = 1.328 Re^(-1/2) + 2.67 Re^(-7/8)"
    )
    parameters = (
        EffectParameter(
            "along",
            "k_a",
            "1",
            0.0,
            0.0,
            10.0,
            1.0,
            "1 of a plate (Blasius; Messiter 1970), more of a body with a blunt end",
        ),
        EffectParameter(
            "thinning",
            "k_b",
            "1",
            0.0,
            0.0,
            10.0,
            2.7,
            "half of 5.4 of a cylinder across a stream (Taylor 1952)",
        ),
    )
    signature = "Nothing in the angle of a body that is held; sets the speed of one that swims."
    confused_with = ("viscous_drag", "linear_drag")
    separated_by = (
        "Let the body glide: its speed falls with the power 3/2, that of viscous drag in proportion."
    )
    citation = (
        "Schlichting, Boundary-Layer Theory, 7th ed. (1979), section VII e; Messiter, SIAM Journal on Applied "
        "Mathematics 18 (1970) 241"
    )
    needs_medium = True
    sites = "line"
    depends_on = ("velocity", "tangent")

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per length and depth [N/m^2], [n, 2]."""
        motion, fluid = LineMotion.at(at), at.fluid
        nu, speed = fluid.kinematic_viscosity, np.abs(motion.along)
        share = nu / fluid.length
        layer = p.along * (BLASIUS * np.sqrt(share * speed) + TRIPLE_DECK * share**0.875 * speed**0.125)
        thinned = p.thinning**2 * nu * np.abs(motion.across) / fluid.depth
        return (-fluid.density * np.sqrt(layer**2 + thinned) * motion.along)[:, None] * motion.tangent
