# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Zipping hysteresis: films that have touched stick, and let go at a lower voltage."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.drive.drive_hysteresis import DriveHysteresis
from hasel_sim.muscle.effect import MuscleEffect


class ZippingHysteresis(MuscleEffect):
    """The drive's play operator on the voltage, on the bench."""

    id = "zipping_hysteresis"
    physics = DriveHysteresis.physics
    equation = "y = max(abs(V) - w, min(abs(V) + w, y)), y(0) = 0; y pulls instead of V"
    parameters = DriveHysteresis.parameters
    signature = "Higher voltages are needed going up than coming down, however slowly."
    citation = DriveHysteresis.citation
    in_time = True

    def electrodes(self, time: np.ndarray, voltage: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Voltage [V] that the zipped state corresponds to."""
        return DriveHysteresis().respond(time, voltage[:, None], p)[:, 0]
