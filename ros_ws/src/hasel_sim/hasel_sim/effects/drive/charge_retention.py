# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Charge retention: charge creeps into the film and shields part of the field."""

from types import SimpleNamespace

import numpy as np
from numba import njit

from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter


class ChargeRetention(DriveEffect):
    """Slow charge at the film's surface that opposes the applied voltage and outlives it."""

    id = "charge_retention"
    physics = "Charge slowly collects in and on the film, opposes the field, and stays when the voltage goes."
    equation = "dq/dt = (V - q) / tau_q, V_eff = V - beta q"
    parameters = (
        EffectParameter(
            "fraction",
            "beta",
            "1",
            0.0,
            0.0,
            0.5,
            0.15,
            "drift of Peano-HASEL strokes: 0.02-0.4 (estimate)",
            usual=(0.02, 0.4),
        ),
        EffectParameter(
            "time",
            "tau_q",
            "s",
            3.0,
            0.1,
            300.0,
            3.0,
            "1-300 s (estimate from reported drift)",
            scan=(0.3, 1.0, 3.0, 10.0, 30.0),
        ),
    )
    signature = (
        "Amplitude decays over the run; the muscle that is off keeps pulling; scales with voltage and time "
        "switched on."
    )
    confused_with = ("gain_drift", "viscoelastic_creep", "muscle_asymmetry")
    separated_by = (
        "Reverse the polarity every cycle: retention vanishes, mechanical creep and gain drift stay."
    )
    citation = "Cisneros, Wu, Rabenorosoa, Le Gorrec, Mechatronics 109 (2025) 103342"
    quantity = "voltage"
    stage = DriveStage.ZIPPING

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Effective voltage [V] from the one on the electrodes, both signed."""
        return signal - p.fraction * _charge(time, signal, p.time)


@njit(cache=True)
def _charge(time: np.ndarray, signal: np.ndarray, relaxation: float) -> np.ndarray:
    out = np.zeros_like(signal)
    for muscle in range(signal.shape[1]):
        for i in range(1, signal.shape[0]):
            r = (time[i] - time[i - 1]) / relaxation
            before, after = signal[i - 1, muscle], signal[i, muscle]
            # exact for a voltage that changes steadily over the interval
            fade = np.exp(-r)
            mean = 1.0 - 0.5 * r if r < 1e-6 else -np.expm1(-r) / r
            out[i, muscle] = out[i - 1, muscle] * fade + before * (mean - fade) + after * (1.0 - mean)
    return out
