# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Payload: a mass at the tail marker, such as the marker itself."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState


class Payload(ForceEffect):
    """Point mass at the tail marker with its weight and its inertia."""

    id = "payload"
    physics = "A mass at the tail, such as a marker or a sensor, adds its inertia and its weight there."
    equation = "f = m_p (g - a) at the tail marker"
    parameters = (
        EffectParameter(
            "mass", "m_p", "kg/m", 0.0, 0.0, 10.0, 0.01, "a printed marker of 0.1-1 g on 0.05 m of depth"
        ),
    )
    signature = (
        "Lower resonance, and under gravity more static deflection; the ratio of the two gives the mass."
    )
    confused_with = ("added_mass", "soft_modulus")
    separated_by = "Weigh the body with and without it; static deflection and frequency together."
    citation = "Rayleigh, The Theory of Sound, vol. 1 (1894), section 88"
    sites = "points"
    depends_on = ("acceleration",)

    def points(self, markers: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """The tail marker."""
        return markers[2:]

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per depth [N/m], [1, 2]."""
        return p.mass * (at.gravity - at.acceleration)
