# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Antagonist slack: a relaxed muscle's film lets itself be stretched only a little."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, MaterialEffect, MaterialPoints
from hasel_sim.mesh.mesh import Region


class AntagonistSlack(MaterialEffect):
    """Inextensible film of the muscle on the stretched side."""

    id = "antagonist_slack"
    physics = (
        "The film of the muscle on the convex side cannot stretch; once its slack is used up it stops the "
        "bending."
    )
    equation = "tension += k_f max(0, abs(F m) - 1 - eps_s)"
    parameters = (
        EffectParameter(
            "stiffness",
            "k_f",
            "Pa",
            0.0,
            0.0,
            1e6,
            1e5,
            "0.3-3 kN/m of a 0.1 m long film over its 2.5 cm^2: 0.1-1.2 MPa",
            usual=(100000.0, 1200000.0),
        ),
        EffectParameter(
            "slack_strain",
            "eps_s",
            "1",
            0.005,
            0.0,
            0.1,
            0.005,
            "a half-filled pouch lengthens by about 1 %",
            scan=(0.0, 0.0025, 0.005, 0.01, 0.02),
        ),
    )
    signature = (
        "Clipped peaks with a third harmonic at the highest voltage; the lowest voltage is unaffected."
    )
    confused_with = ("force_length", "spine_stiffening", "soft_modulus")
    separated_by = "Bend the body by hand with one muscle cut: the force-angle curve loses its knee."
    citation = (
        "Kazemipour, Hinchet, Katzschmann, ICRA 2025 (arXiv 2409.11017): clutches for non-stretchable "
        "antagonists"
    )
    needs_muscles = True
    regions = (Region.UPPER_MUSCLE, Region.LOWER_MUSCLE)

    def first_piola(self, at: MaterialPoints, p: SimpleNamespace) -> np.ndarray:
        """Stress of the taut film [Pa], [n, 2, 2]."""
        return at.along_fibre(p.stiffness * np.maximum(0.0, at.stretch - 1.0 - p.slack_strain))
