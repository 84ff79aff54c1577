# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Viscous drag: the slow fluid around a slender body."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState
from hasel_sim.effects.slender import LineMotion


class ViscousDrag(ForceEffect):
    """Resistive force of slow flow, in proportion to the velocity across and along the centre line."""

    id = "viscous_drag"
    physics = (
        "Slow viscous fluid resists each piece of the body in proportion to its velocity, about twice as much across "
        "as along it, which is what lets a wave push."
    )
    equation = "f = -(mu / H) (K_n (v.n) n + K_t (v.t) t) per length of the centre line and depth H"
    parameters = (
        EffectParameter(
            "across",
            "K_n",
            "1",
            0.0,
            0.0,
            200.0,
            8.0,
            "4 pi / (ln(4 L / H) + 1/2) = 4-6 in slow flow; 30-140 with the layer that oscillates at 0.5-7 Hz",
            usual=(4.0, 140.0),
        ),
        EffectParameter(
            "along",
            "K_t",
            "1",
            0.0,
            0.0,
            100.0,
            4.0,
            "half of that across for a slender body (Gray and Hancock 1955)",
        ),
    )
    signature = (
        "Damping in proportion to velocity, whatever the amplitude; a wave swims at a share of its own speed."
    )
    confused_with = ("linear_drag", "normal_drag", "skin_friction", "material_damping")
    separated_by = (
        "Ring-down in the fluid at small and large amplitude: its decrement stays; warm oil weakens it."
    )
    citation = "Gray and Hancock, Journal of Experimental Biology 32 (1955) 802"
    needs_medium = True
    sites = "line"
    depends_on = ("velocity", "tangent")

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per length and depth [N/m^2], [n, 2]."""
        motion, fluid = LineMotion.at(at), at.fluid
        across = (p.across * motion.across)[:, None] * motion.normal
        along = (p.along * motion.along)[:, None] * motion.tangent
        return -fluid.viscosity / fluid.depth * (across + along)
