# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Linear drag: slow surroundings brake in proportion to velocity."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState


class LinearDrag(ForceEffect):
    """Mass-proportional viscous drag, the alpha of Rayleigh damping."""

    id = "linear_drag"
    physics = "A slow viscous medium brakes every part of the body in proportion to its velocity."
    equation = "f = -c m v"
    parameters = (
        EffectParameter(
            "rate",
            "c",
            "1/s",
            0.0,
            0.0,
            20.0,
            2.0,
            "viscous part in oil 2-10 N s/m^2 over the mass per length",
        ),
    )
    signature = "Exponential ring-down at small amplitude; damping ratio c / (2 omega) falls with frequency."
    confused_with = ("material_damping", "structural_damping", "quadratic_drag")
    separated_by = (
        "Ring-down of the first two modes: drag damps the slower one more, the material the faster one."
    )
    citation = "Clough and Penzien, Dynamics of Structures, 3rd ed. (2003), section 12-5"
    depends_on = ("velocity",)

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per mass [N/kg], [n, 2]."""
        return -p.rate * at.velocity
