# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Tether: the supply's leads hold the body sideways."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState


class Tether(ForceEffect):
    """Sideways spring at one point of the centre line."""

    id = "tether"
    physics = "The high-voltage leads pull the point where they leave the body back to where it was."
    equation = "f = -k (y - y_0) at x_t on the centre line"
    parameters = (
        EffectParameter(
            "stiffness",
            "k",
            "N/m^2",
            0.0,
            0.0,
            100.0,
            5.0,
            "tension over length of the leads, 0.005-0.05 N/m, per 0.05 m of depth",
        ),
        EffectParameter(
            "position",
            "x_t",
            "m",
            0.05,
            0.0,
            0.5,
            0.05,
            "where the leads leave the body, from the nose",
            scan=(0.005, 0.05, 0.094, 0.15),
        ),
    )
    signature = "Slow return of position and heading; almost nothing in the angle between the segments."
    confused_with = ("soft_modulus", "gravity_tilt", "linear_drag")
    separated_by = "Move the tether's anchor by 5 cm; a second dummy lead doubles the effect."
    citation = "Timoshenko, Young, Weaver, Vibration Problems in Engineering, 4th ed. (1974), section 1.2"
    sites = "points"
    depends_on = ("position",)

    def points(self, markers: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """The point held; a position beyond the tail marker means the tail marker."""
        return np.array([[min(p.position, markers[2, 0]), 0.0]])

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per depth [N/m], [1, 2]."""
        return -p.stiffness * (at.position - at.reference) * np.array([0.0, 1.0])
