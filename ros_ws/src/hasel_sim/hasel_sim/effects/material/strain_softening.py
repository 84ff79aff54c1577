# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Strain softening: the soft material resists less, the more it is strained."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, MaterialEffect, MaterialPoints
from hasel_sim.mesh.mesh import Region


class StrainSoftening(MaterialEffect):
    """A shear modulus that falls by a share d from small strains to large ones, reversibly."""

    id = "strain_softening"
    physics = "Filler networks of silicones and gels break up with strain, so the shear modulus falls (Payne effect)."
    equation = (
        "W -= d mu/2 (I - e ln(1 + I/e)), I = I1 - 2 - 2 ln J, e = 2 eps_0^2: modulus mu (1 - d I/(I + e))"
    )
    parameters = (
        EffectParameter(
            "softening",
            "d",
            "1",
            0.0,
            0.0,
            0.7,
            0.3,
            "10-50 % between 1 and 50 % of strain in filled silicones; at most as soft as soft_modulus may be",
            usual=(0.1, 0.5),
        ),
        EffectParameter(
            "reference_strain",
            "eps_0",
            "1",
            0.05,
            0.005,
            0.5,
            0.05,
            "1-10 % (Payne); more in unfilled rubbers",
            scan=(0.02, 0.05, 0.1, 0.2),
        ),
    )
    signature = (
        "Large swings are slower than small ones, and the body bends more than in proportion to the drive."
    )
    confused_with = ("drive_softening", "spine_stiffening", "force_length")
    separated_by = "Ring-downs from several heights without drive: frequency over amplitude."
    citation = "Payne, Journal of Applied Polymer Science 6 (1962) 57"
    regions = (Region.SOFT, Region.UPPER_MUSCLE, Region.LOWER_MUSCLE)

    def first_piola(self, at: MaterialPoints, p: SimpleNamespace) -> np.ndarray:
        """What the softer material pulls less [Pa], [n, 2, 2]."""
        excess = np.einsum("nij,nij->n", at.deformation, at.deformation) - 2.0 - 2.0 * np.log(at.volume_ratio)
        share = excess / (excess + 2.0 * p.reference_strain**2)
        return -(p.softening * at.shear * share)[:, None, None] * at.distortion
