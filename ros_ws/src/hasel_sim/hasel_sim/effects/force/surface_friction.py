# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Surface friction: dry friction of the body lying on a table."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState

GRAVITY = 9.81
"""Standard acceleration of fall [m/s^2]; the table carries the body's whole weight."""
SMOOTHING_VELOCITY = 0.004
"""Velocity [m/s] below which friction fades, instead of jumping at zero."""


class SurfaceFriction(ForceEffect):
    """Coulomb friction on the surface under the body, smoothed about standstill."""

    id = "surface_friction"
    physics = (
        "The body lies on a surface whose dry friction opposes the motion with a force that does not grow "
        "with speed."
    )
    equation = "f = -mu m g v / sqrt(abs(v)^2 + v_0^2), v_0 = 4 mm/s, g = 9.81 m/s^2"
    parameters = (
        EffectParameter(
            "coefficient",
            "mu",
            "1",
            0.0,
            0.0,
            1.0,
            0.05,
            "oiled or PTFE 0.1 to tacky elastomer 1",
            usual=(0.1, 1.0),
        ),
    )
    signature = (
        "Relatively largest at the lowest voltage; stays behind at reversals; lag falls with voltage; gone "
        "in oil."
    )
    confused_with = ("quadratic_drag", "structural_damping", "drive_hysteresis", "material_damping")
    separated_by = (
        "Hang or float the body; ring-down with a linear envelope is dry friction, an exponential one is "
        "viscous."
    )
    citation = "Den Hartog, Mechanical Vibrations, 4th ed. (1956), section 8.3"
    depends_on = ("velocity",)

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per mass [N/kg], [n, 2]."""
        speed = np.sqrt(at.velocity[:, 0] ** 2 + at.velocity[:, 1] ** 2 + SMOOTHING_VELOCITY**2)
        return -p.coefficient * GRAVITY * at.velocity / speed[:, None]
