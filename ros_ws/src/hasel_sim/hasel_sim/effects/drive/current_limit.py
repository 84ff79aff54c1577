# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Current limit: the supply can only charge the electrodes so fast."""

from types import SimpleNamespace

import numpy as np
from numba import njit

from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter


class CurrentLimit(DriveEffect):
    """Slew rate of the supply into a capacitive load."""

    id = "current_limit"
    physics = "The supply's current is limited, so the voltage on the electrodes changes at a limited rate."
    equation = "abs(dV/dt) <= r, r = I_max / C"
    parameters = (
        EffectParameter(
            "inverse_rate",
            "1/r",
            "s/V",
            0.0,
            0.0,
            1e-4,
            2e-5,
            "C / I_max: 0.3-3 nF at 0.11-0.5 mA gives 6e-7 to 3e-5 s/V (hvps-x data sheet)",
            usual=(6e-07, 3e-05),
        ),
    )
    signature = (
        "Rise time proportional to the voltage: runs at low voltage start earlier than runs at high voltage."
    )
    confused_with = ("charging_lag", "hydraulic_lag")
    separated_by = (
        "Two voltages: equal milliseconds mean a resistor, milliseconds in proportion to voltage a current "
        "limit."
    )
    citation = "Horowitz and Hill, The Art of Electronics, 3rd ed. (2015), section 1.4.4"
    quantity = "voltage"
    stage = DriveStage.SUPPLY

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Voltage that the supply delivers [V] from the one commanded."""
        return _limit_slew(time, signal, p.inverse_rate) if p.inverse_rate > 0 else signal


@njit(cache=True)
def _limit_slew(time: np.ndarray, signal: np.ndarray, inverse_rate: float) -> np.ndarray:
    out = np.empty_like(signal)
    for muscle in range(signal.shape[1]):
        value = 0.0
        for i in range(signal.shape[0]):
            reach = (time[i] - time[i - 1]) / inverse_rate if i > 0 else 0.0
            value = min(max(signal[i, muscle], value - reach), value + reach)
            out[i, muscle] = value
    return out
