# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Drive hysteresis: the pouch zips at a higher voltage than it releases."""

from types import SimpleNamespace

import numpy as np
from numba import njit

from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter


class DriveHysteresis(DriveEffect):
    """Play between voltage and zipped state."""

    id = "drive_hysteresis"
    physics = (
        "Zipping starts at a higher voltage than release, so the zipped state lags the voltage like a play."
    )
    equation = (
        "y = max(abs(V) - w, min(abs(V) + w, y)), y(0) = 0; the contraction follows y instead of abs(V)"
    )
    parameters = (
        EffectParameter(
            "width",
            "w",
            "V",
            0.0,
            0.0,
            2500.0,
            500.0,
            "release 5-30 % below a pull-in voltage of 1-4 kV (estimate)",
        ),
    )
    signature = (
        "Less contraction when on and some left when off, whatever the frequency; the mean depends on the "
        "history."
    )
    confused_with = ("charge_retention", "surface_friction", "structural_damping")
    separated_by = (
        "A slow triangle of voltage at two rates, hanging in air: a loop that stays is hysteresis, one that "
        "shrinks a lag."
    )
    citation = "Visintin, Differential Models of Hysteresis (1994), chapter III (play operator)"
    quantity = "voltage"
    stage = DriveStage.ZIPPING

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Voltage [V] that the zipped state corresponds to."""
        return _play(np.abs(signal), p.width)


@njit(cache=True)
def _play(magnitude: np.ndarray, width: float) -> np.ndarray:
    out = np.empty_like(magnitude)
    for muscle in range(magnitude.shape[1]):
        state = 0.0
        for i in range(magnitude.shape[0]):
            state = max(magnitude[i, muscle] - width, min(magnitude[i, muscle] + width, state))
            out[i, muscle] = state
    return out
