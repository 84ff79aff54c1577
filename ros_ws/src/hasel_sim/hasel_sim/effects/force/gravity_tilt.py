# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Gravity tilt: the table or tank is not level."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState

GRAVITY = 9.81


class GravityTilt(ForceEffect):
    """Sideways part of the weight on a tilted plane."""

    id = "gravity_tilt"
    physics = "On a tilted plane part of the weight acts sideways; a free body only slides, a held one bends."
    equation = "f = m g sin(tilt) sideways, g = 9.81 m/s^2"
    parameters = (
        EffectParameter("tilt", "phi", "rad", 0.0, -0.2, 0.2, 0.02, "levelling by eye: 1 degree = 0.017 rad"),
    )
    signature = (
        "A constant deflection of a held body; none in the angle of a free body without friction or tether."
    )
    confused_with = ("pre_bend", "muscle_asymmetry", "marker_offset")
    separated_by = (
        "Turn the body by 180 degrees on the table: the deflection changes sign, a bent body's does not."
    )
    citation = "Timoshenko and Gere, Mechanics of Materials (1972), chapter 6 (uniformly loaded beam)"
    depends_on = ()

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per mass [N/kg], [n, 2]."""
        return np.broadcast_to([0.0, GRAVITY * np.sin(p.tilt)], at.position.shape)
