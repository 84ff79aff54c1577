# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Spine stiffening: the spine resists more, the more it is strained."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, MaterialEffect, MaterialPoints
from hasel_sim.mesh.mesh import Region


class SpineStiffening(MaterialEffect):
    """Fourth-order term in the spine's strain energy."""

    id = "spine_stiffening"
    physics = "The spine's polymer chains straighten, so that it stiffens with strain (a Duffing spring)."
    equation = "W += k E_xx^4, E_xx the Green strain along the spine: S_xx += 4 k E_xx^3"
    parameters = (
        EffectParameter(
            "stiffening",
            "k",
            "Pa",
            0.0,
            0.0,
            1e9,
            1e7,
            "30 % more bending stiffness at 1-3 1/m of curvature (estimate)",
        ),
    )
    signature = "Third harmonic; the resonance moves up with voltage; the highest voltage is over-predicted."
    confused_with = ("force_length", "antagonist_slack", "spine_modulus")
    separated_by = "Static moment against curvature with the muscles removed."
    citation = "Nayfeh and Mook, Nonlinear Oscillations (1979), section 7.1"
    needs_spine = True
    regions = (Region.SPINE,)

    def first_piola(self, at: MaterialPoints, p: SimpleNamespace) -> np.ndarray:
        """Stress of the additional energy [Pa], [n, 2, 2]."""
        strain = 0.5 * (at.stretch**2 - 1.0)
        return at.along_fibre(4.0 * p.stiffening * strain**3 * at.stretch)
