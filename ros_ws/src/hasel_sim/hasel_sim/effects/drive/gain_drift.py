# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Gain drift: the muscles tire within a run."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter


class GainDrift(DriveEffect):
    """Steady loss of stroke during a run."""

    id = "gain_drift"
    physics = "Warming, ageing or leaking muscles lose stroke steadily during a run."
    equation = "amplitude x (1 - k t), t from the start of the run"
    parameters = (
        EffectParameter(
            "rate", "k", "1/s", 0.0, -0.2, 0.2, 0.03, "2-8 % between runs of some seconds (estimate)"
        ),
    )
    signature = (
        "Both half-cycles shrink from cycle to cycle, in proportion to time and whatever the voltage's sign."
    )
    confused_with = ("charge_retention", "viscoelastic_creep")
    separated_by = "Reverse the polarity every cycle: charge retention vanishes, drift of the gain stays."
    citation = "Kellaris et al., Science Robotics 3 (2018) eaar3276"
    stage = DriveStage.TARGET

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Contraction aimed at [1], less and less of it."""
        return signal * np.maximum(1.0 - p.rate * (time - time[0]), 0.0)[:, None]
