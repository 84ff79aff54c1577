# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Spine modulus: the spine's stiffness in the model file is wrong."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import Coefficients, EffectParameter, MaterialEffect
from hasel_sim.mesh.mesh import Region


class SpineModulus(MaterialEffect):
    """A wrong constant, reported as one."""

    id = "spine_modulus"
    physics = "Young's modulus of the spine is not the one in the model file, which is far below that of polypropylene."
    equation = "E_spine <- scale E_spine (its viscosity with it)"
    parameters = (
        EffectParameter(
            "scale",
            "s_E",
            "1",
            1.0,
            0.3,
            3.0,
            1.3,
            "solid polypropylene would be 1.4 GPa: a homogenised value",
        ),
    )
    signature = (
        "The fin's phase and the resonance are wrong while the contraction makes up for the amplitude."
    )
    confused_with = ("soft_modulus", "spine_stiffening", "added_mass")
    separated_by = "Three-point bending of the bare spine and of the body; a pluck with and without spine."
    citation = "Timoshenko, Young, Weaver, Vibration Problems in Engineering, 4th ed. (1974), section 5.9"
    needs_spine = True

    def modify(self, coefficients: Coefficients, p: SimpleNamespace) -> None:
        """Scale the elastic constants of the spine."""
        factor = np.where(coefficients.region == Region.SPINE, p.scale, 1.0)
        coefficients.shear *= factor
        coefficients.lame *= factor
