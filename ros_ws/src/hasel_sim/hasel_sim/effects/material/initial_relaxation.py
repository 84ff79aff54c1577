# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Initial relaxation: stress of the starting shape that has yet to relax."""

from types import SimpleNamespace

from hasel_sim.effects.base import EffectParameter, MaterialEffect


class InitialRelaxation(MaterialEffect):
    """What the material remembers at the start of a run of how it was bent before, and forgets during the run."""

    id = "initial_relaxation"
    physics = (
        "Bent into its starting shape only just before, the material still carries stress that relaxes "
        "during the run."
    )
    equation = "S = C : E + q, q(0) = g C : E(0), dq/dt = -q / tau"
    parameters = (
        EffectParameter(
            "share",
            "g",
            "1",
            0.0,
            -0.5,
            0.5,
            0.1,
            "5-20 % per decade of time in silicones, below 0 where it was bent further before (estimate)",
        ),
        EffectParameter(
            "relaxation_time",
            "tau",
            "s",
            1.0,
            0.05,
            30.0,
            1.0,
            "what relaxes within a run",
            scan=(0.1, 0.3, 1.0, 3.0, 10.0),
        ),
    )
    signature = "The body sinks towards its load while it swings and after; in every run anew, and not under the drive."
    confused_with = ("viscoelastic_creep", "slow_creep", "gravity_tilt")
    separated_by = "Hold the body in its starting shape for a minute before it is let go."
    needs_strained_start = True
    citation = "Ferry, Viscoelastic Properties of Polymers, 3rd ed. (1980), chapter 3"

    def fading(self, p: SimpleNamespace) -> list[tuple[float, float]]:
        """The stress at the start and its time."""
        return [(p.share, p.relaxation_time)]
