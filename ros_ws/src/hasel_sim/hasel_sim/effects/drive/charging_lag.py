# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Charging lag: the electrodes are a capacitor behind a resistor."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter
from hasel_sim.effects.first_order_lag import first_order_lag


class ChargingLag(DriveEffect):
    """RC lag of each muscle's electrodes, with a time of its own for discharging."""

    id = "charging_lag"
    physics = "The electrodes charge through the source's resistance and discharge through another one."
    equation = (
        "dV/dt = (V_cmd - V) / tau, tau = charge_time while abs(V) rises, discharge_time while it falls"
    )
    parameters = (
        EffectParameter(
            "charge_time",
            "tau_c",
            "s",
            0.0,
            0.0,
            0.5,
            0.05,
            "R C: 1-20 MOhm in series with 0.4-1.8 nF per muscle gives 0.3-60 ms",
            difference=5e-7,
            usual=(0.0003, 0.06),
        ),
        EffectParameter(
            "discharge_time",
            "tau_d",
            "s",
            0.0,
            0.0,
            0.5,
            0.05,
            "R C: about 0.1 s for 1 nF through a 100 MOhm bleed resistor (hvps-x data sheet)",
            difference=5e-7,
        ),
    )
    signature = (
        "Odd harmonics right after every switch; the same milliseconds at every voltage, more error at high "
        "frequency."
    )
    confused_with = ("hydraulic_lag", "current_limit", "transport_delay")
    separated_by = (
        "A high-voltage probe (1 GOhm or more) on the muscle; or a known capacitor in parallel: the lag "
        "scales."
    )
    citation = "Horowitz and Hill, The Art of Electronics, 3rd ed. (2015), section 1.4"
    stage = DriveStage.ELECTRODE

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Voltage on the electrodes [V] from the one supplied."""
        return first_order_lag(time, signal, p.charge_time, p.discharge_time)
