# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Viscous flow: the liquid takes time to move out from between the films."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter
from hasel_sim.effects.first_order_lag import first_order_lag
from hasel_sim.muscle.effect import MuscleEffect


class ViscousFlow(MuscleEffect):
    """The contraction follows its balance through a first-order lag."""

    id = "viscous_flow"
    physics = "Liquid must flow out from between the films and back, so that the contraction follows late."
    equation = "dx/dt = (x_0 - x) / tau"
    parameters = (
        EffectParameter(
            "time", "tau", "s", 0.0, 0.0, 5.0, 0.2, "milliseconds for oils, seconds in thin gaps (estimate)"
        ),
    )
    signature = "Settles exponentially after every switch and ends where it would have been."
    citation = "Rothemund, Kirkman, Keplinger, PNAS 117 (2020) 16207 (viscous regime)"
    in_time = True

    def follow(self, time: np.ndarray, contraction: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Contraction [m], late."""
        return first_order_lag(time, contraction[:, None], p.time, p.time)[:, 0]
