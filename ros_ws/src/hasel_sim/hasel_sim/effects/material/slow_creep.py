# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Slow creep: a second, longer time with which stress relaxes."""

from types import SimpleNamespace

from hasel_sim.effects.base import EffectParameter, MaterialEffect


class SlowCreep(MaterialEffect):
    """A second Prony term beside that of viscoelastic_creep, with a time of many seconds."""

    id = "slow_creep"
    physics = "Silicones relax over many decades of time, so a body that has crept for a second goes on for minutes."
    equation = "S = C : E + q, dq/dt = g C : dE/dt - q / tau, tau beyond that of viscoelastic_creep"
    parameters = (
        EffectParameter(
            "modulus_ratio",
            "g",
            "1",
            0.0,
            0.0,
            1.0,
            0.15,
            "5-20 % per decade of time in silicones (estimate)",
            usual=(0.05, 0.2),
        ),
        EffectParameter(
            "relaxation_time",
            "tau",
            "s",
            20.0,
            5.0,
            300.0,
            20.0,
            "seconds to minutes",
            scan=(10.0, 30.0, 100.0),
        ),
    )
    signature = "A drift towards the load that a creep of about a second leaves, the same in every cycle of a long run."
    confused_with = ("viscoelastic_creep", "gain_drift", "drive_creep")
    separated_by = (
        "Hold for a minute and let go: a second time shows as a second slope over the logarithm of time."
    )
    citation = "Ferry, Viscoelastic Properties of Polymers, 3rd ed. (1980), chapter 3"

    def branches(self, p: SimpleNamespace) -> list[tuple[float, float]]:
        """The Prony term."""
        return [(p.modulus_ratio, p.relaxation_time)]
