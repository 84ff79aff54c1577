# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Material damping: more Kelvin-Voigt viscosity than the model's nominal one."""

from types import SimpleNamespace

from hasel_sim.effects.base import Coefficients, EffectParameter, MaterialEffect


class MaterialDamping(MaterialEffect):
    """Additional viscous stress proportional to the rate of strain."""

    id = "material_damping"
    physics = (
        "The elastomer loses more energy per cycle than the nominal one, in proportion to its rate of strain."
    )
    equation = "S_v = tau C : dE/dt in addition to the model's own"
    parameters = (
        EffectParameter(
            "retardation_time",
            "tau",
            "s",
            0.0,
            0.0,
            0.2,
            0.02,
            "eta / E: 0.1-3 kPa s over 65 kPa gives 2-46 ms (estimate from loss tangents of 0.02-0.5)",
            usual=(0.002, 0.046),
        ),
    )
    signature = "Ringing after each switch dies faster; damping ratio omega tau / 2 grows with frequency."
    confused_with = ("linear_drag", "structural_damping", "quadratic_drag")
    separated_by = (
        "Ring-down of a plucked body in air, on the surface and in oil; and of its first two modes."
    )
    citation = "Lakes, Viscoelastic Materials (2009), section 2.4"

    def modify(self, coefficients: Coefficients, p: SimpleNamespace) -> None:
        """Lengthen the retardation time everywhere."""
        coefficients.retardation += p.retardation_time
