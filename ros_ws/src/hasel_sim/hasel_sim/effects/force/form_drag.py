# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Form drag: the wake behind a blunt body."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState
from hasel_sim.effects.slender import LineMotion


class FormDrag(ForceEffect):
    """Resistance along the way that grows with the square of the speed, spread over the length of the body."""

    id = "form_drag"
    physics = (
        "Flow along a blunt or rough body separates behind it and holds it back with the square of the speed."
    )
    equation = "f = -1/2 rho C_t abs(u) u t per length of the centre line and depth H, u = v.t"
    parameters = (
        EffectParameter(
            "coefficient",
            "C_t",
            "1",
            0.0,
            0.0,
            2.0,
            0.1,
            "frontal area over side area, times 1 of a blunt body and 0.1 of a streamlined one (Hoerner 1965)",
        ),
    )
    signature = "Nothing in the angle of a body that is held; sets the speed of one that swims."
    confused_with = ("skin_friction", "viscous_drag")
    separated_by = (
        "Let the body glide: one over its speed grows linearly, of skin friction one over the root does."
    )
    citation = "Hoerner, Fluid-Dynamic Drag (1965), chapter 3"
    needs_medium = True
    sites = "line"
    depends_on = ("velocity", "tangent")

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per length and depth [N/m^2], [n, 2]."""
        motion = LineMotion.at(at)
        drag = -0.5 * at.fluid.density * p.coefficient * np.abs(motion.along) * motion.along
        return drag[:, None] * motion.tangent
