# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Drive softening: where a muscle contracts, the body around it changes its stiffness."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, MaterialEffect, MaterialPoints
from hasel_sim.mesh.mesh import Region


class DriveSoftening(MaterialEffect):
    """A shear modulus that falls (or rises) with the contraction of the muscle that lies there."""

    id = "drive_softening"
    physics = (
        "Inflated walls are thin, zipped pouches are taut: a driven muscle changes the stiffness of the body."
    )
    equation = "mu <- mu (1 - s tanh(a)) in the muscle, a its contraction"
    parameters = (
        EffectParameter(
            "softening",
            "s",
            "1",
            0.0,
            -0.9,
            0.9,
            0.5,
            "frequencies of bellows fall or rise by 5-30 % with pressure (estimate)",
        ),
    )
    signature = "The body rings at another frequency while it is driven than after it is let off."
    confused_with = ("strain_softening", "force_length", "antagonist_slack")
    separated_by = "Ring-downs with the muscle held at several levels: frequency over drive."
    citation = "Mosadegh et al., Advanced Functional Materials 24 (2014) 2163"
    needs_muscles = True
    regions = (Region.UPPER_MUSCLE, Region.LOWER_MUSCLE)

    def first_piola(self, at: MaterialPoints, p: SimpleNamespace) -> np.ndarray:
        """What the softer material pulls less [Pa], [n, 2, 2]."""
        return -(p.softening * np.tanh(at.contraction) * at.shear)[:, None, None] * at.distortion
