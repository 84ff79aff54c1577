# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Soft modulus: the soft material's stiffness in the model file is wrong."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import Coefficients, EffectParameter, MaterialEffect
from hasel_sim.mesh.mesh import Region


class SoftModulus(MaterialEffect):
    """A wrong constant, reported as one."""

    id = "soft_modulus"
    physics = "Young's modulus of the soft material is not the one in the model file: batch, temperature or swelling."
    equation = "E_soft <- scale E_soft (its viscosity with it; the muscles' fibres keep their stiffness)"
    parameters = (
        EffectParameter(
            "scale",
            "s_E",
            "1",
            1.0,
            0.3,
            3.0,
            1.2,
            "plane strain 1.25, hollow shell 0.3, printed against moulded",
        ),
    )
    signature = "Resonance and amplitude wrong together, in the same way at every voltage."
    confused_with = ("spine_modulus", "added_mass", "spine_stiffening")
    separated_by = "A static load test and a pluck: together they give stiffness and mass separately."
    citation = "Timoshenko, Young, Weaver, Vibration Problems in Engineering, 4th ed. (1974), section 5.9"

    def modify(self, coefficients: Coefficients, p: SimpleNamespace) -> None:
        """Scale the elastic constants of everything but the spine."""
        factor = np.where(coefficients.region == Region.SPINE, 1.0, p.scale)
        coefficients.shear *= factor
        coefficients.lame *= factor
