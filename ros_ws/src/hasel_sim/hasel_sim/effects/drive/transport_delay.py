# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Transport delay: the command reaches the electrodes late."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter


class TransportDelay(DriveEffect):
    """Dead time of software, serial line and optocouplers."""

    id = "transport_delay"
    physics = "The command takes a fixed time through software, serial line and switches to the electrodes."
    equation = "V(t) <- V(t - t_d)"
    parameters = (
        EffectParameter(
            "delay",
            "t_d",
            "s",
            0.0,
            0.0,
            0.1,
            0.02,
            "software timer, serial line, optocoupler: 1-30 ms",
            usual=(0.001, 0.03),
        ),
    )
    signature = (
        "Residual proportional to minus the angular rate; lag grows in proportion to frequency, no loss of "
        "amplitude."
    )
    confused_with = ("camera_latency", "charging_lag", "hydraulic_lag")
    separated_by = (
        "A light on the gate signal in the camera's picture; a frequency sweep against first-order lags."
    )
    citation = "Åström and Murray, Feedback Systems, 2nd ed. (2021), section 10.4"
    stage = DriveStage.COMMAND
    sweeps = False
    exclusive = "delay"

    def clock(self, time: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Everything takes effect later."""
        return time + p.delay
