# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Quadratic drag: the fluid that the skin pushes aside."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState

FLUID_DENSITY = 920.0
"""Density of canola oil at 25 degrees C [kg/m^3]."""


class QuadraticDrag(ForceEffect):
    """Pressure drag on the skin's normal motion (resistive part of Morison's equation)."""

    id = "quadratic_drag"
    physics = (
        "Fluid separates from the moving skin and presses against its normal velocity, in proportion to its "
        "square."
    )
    equation = "f = -1/2 rho_f C_d abs(v.n) (v.n) n per skin length and depth, n its present normal, rho_f = 920 kg/m^3"
    parameters = (
        EffectParameter(
            "coefficient",
            "C_d",
            "1",
            0.0,
            0.0,
            10.0,
            0.3,
            "2-8 on both sides of an oscillating plate (Keulegan and Carpenter 1958), 1-3 of a cylinder",
            usual=(1.0, 8.0),
        ),
    )
    signature = (
        "Damping that grows with amplitude and so with voltage; largest at the highest speed; third harmonic."
    )
    confused_with = ("surface_friction", "linear_drag", "structural_damping", "material_damping")
    separated_by = (
        "Ring-down: one over the decrement is linear in one over the amplitude; three voltages at resonance."
    )
    citation = "Morison, O'Brien, Johnson, Schaaf, Petroleum Transactions AIME 189 (1950) 149"
    sites = "skin"
    depends_on = ("velocity", "tangent")

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per skin length [N/m^2], [n, 2]."""
        normal = at.normal
        speed = at.velocity[:, 0] * normal[:, 0] + at.velocity[:, 1] * normal[:, 1]
        return (-0.5 * FLUID_DENSITY * p.coefficient * np.abs(speed) * speed)[:, None] * normal
