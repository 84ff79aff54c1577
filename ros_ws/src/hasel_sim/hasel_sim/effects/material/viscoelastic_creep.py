# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Viscoelastic creep: stress that relaxes with one time."""

from types import SimpleNamespace

from hasel_sim.effects.base import EffectParameter, MaterialEffect


class ViscoelasticCreep(MaterialEffect):
    """One Prony term: a standard linear solid."""

    id = "viscoelastic_creep"
    physics = "Entangled chains carry stress at first and let go of it, so the body yields further under a held load."
    equation = "S = C : E + q, dq/dt = g C : dE/dt - q / tau"
    parameters = (
        EffectParameter(
            "modulus_ratio",
            "g",
            "1",
            0.0,
            0.0,
            1.0,
            0.25,
            "0.1-0.5 of the long-term modulus (estimate)",
            usual=(0.1, 0.5),
        ),
        EffectParameter(
            "relaxation_time",
            "tau",
            "s",
            0.3,
            0.05,
            10.0,
            0.3,
            "thermoplastic elastomers relax over decades of time",
            scan=(0.05, 0.1, 0.3, 1.0, 3.0, 10.0),
        ),
    )
    signature = (
        "The plateau still rises at the lowest frequency; what fits at high frequency is too stiff at low "
        "frequency."
    )
    confused_with = ("charge_retention", "gain_drift", "structural_damping")
    separated_by = (
        "Hold 5 kV for a minute with reversing polarity, which removes charge retention; then let go."
    )
    citation = "Simo and Hughes, Computational Inelasticity (1998), section 10.3"

    def branches(self, p: SimpleNamespace) -> list[tuple[float, float]]:
        """The Prony term."""
        return [(p.modulus_ratio, p.relaxation_time)]
