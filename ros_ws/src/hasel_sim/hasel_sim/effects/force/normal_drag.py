# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Normal drag: fluid that flows across the body and around its edges."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState
from hasel_sim.effects.slender import LineMotion


class NormalDrag(ForceEffect):
    """Taylor's resistance of a long narrow body to flow across it: pressure, and the layer that this flow drags."""

    id = "normal_drag"
    physics = (
        "Flow across the body separates at its edges and presses against it, and its boundary layer adds friction "
        "that matters at low Reynolds numbers."
    )
    equation = (
        "f = -1/2 rho (C_d abs(w) w + C_b sqrt(nu abs(w) / H) w) n per length of the centre line and depth H, "
        "w = v.n"
    )
    parameters = (
        EffectParameter(
            "coefficient",
            "C_d",
            "1",
            0.0,
            0.0,
            10.0,
            1.5,
            "1.1 of a smooth cylinder (Taylor 1952), 2 of a plate, 2-8 of an oscillating plate (Keulegan and Carpenter "
            "1958)",
            usual=(1.1, 8.0),
        ),
        EffectParameter(
            "boundary_layer",
            "C_b",
            "1",
            0.0,
            0.0,
            20.0,
            4.0,
            "4 of a cylinder at Reynolds numbers of 20 to 10^5 (Taylor 1952)",
        ),
    )
    signature = (
        "Damping that grows with amplitude; thrust of a wave in proportion to the square of its speed."
    )
    confused_with = ("quadratic_drag", "viscous_drag", "surface_friction", "material_damping")
    separated_by = "Ring-down in the fluid: one over the decrement is linear in one over the amplitude."
    citation = "Taylor, Proceedings of the Royal Society A 214 (1952) 158"
    needs_medium = True
    sites = "line"
    depends_on = ("velocity", "tangent")

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per length and depth [N/m^2], [n, 2]."""
        motion, fluid = LineMotion.at(at), at.fluid
        speed = np.abs(motion.across)
        layer = p.boundary_layer * np.sqrt(fluid.kinematic_viscosity * speed / fluid.depth)
        pressure = -0.5 * fluid.density * (p.coefficient * speed + layer) * motion.across
        return pressure[:, None] * motion.normal
