# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Hydraulic lag: the liquid takes time to leave and to return."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter
from hasel_sim.effects.first_order_lag import first_order_lag


class HydraulicLag(DriveEffect):
    """Viscous flow of the dielectric liquid between the films."""

    id = "hydraulic_lag"
    physics = (
        "Viscous liquid must flow out of the zipping gap and back, so the contraction lags what is aimed at."
    )
    equation = "da/dt = (a_target - a) / tau, tau = rise_time while a rises, release_time while it falls"
    parameters = (
        EffectParameter(
            "rise_time",
            "tau_r",
            "s",
            0.0,
            0.0,
            0.9,
            0.02,
            "12 mu (l/h)^2 / Maxwell pressure: 0.4-10 ms (estimate)",
            usual=(0.0004, 0.01),
        ),
        EffectParameter(
            "release_time",
            "tau_f",
            "s",
            0.0,
            0.0,
            0.9,
            0.1,
            "12 mu (l/h)^2 / elastic pressure: 36-900 ms (estimate)",
            usual=(0.036, 0.9),
        ),
    )
    signature = (
        "Prompt contraction with a tail on release; fundamental lags and loses amplitude with frequency."
    )
    confused_with = ("charging_lag", "current_limit", "transport_delay")
    separated_by = (
        "A high-voltage probe: voltage gone but muscle not means liquid; 15 and 30 degrees C change "
        "viscosity by 40 %."
    )
    citation = "Rothemund, Kirkman, Keplinger, PNAS 117 (2020) 16207"
    stage = DriveStage.CONTRACTION

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Contraction [1] from the one that the electric force alone would give."""
        return first_order_lag(time, signal, p.rise_time, p.release_time)
