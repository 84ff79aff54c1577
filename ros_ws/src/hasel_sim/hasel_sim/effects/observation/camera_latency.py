# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Camera latency: the pictures' time stamps are not the drive's."""

from types import SimpleNamespace

import numpy as np
from scipy.interpolate import CubicSpline

from hasel_sim.effects.base import EffectParameter, ObservationEffect

_MARGIN = 1e-3
"""How much further [s] than needed the body is simulated, so that the last frame has neighbours."""


class CameraLatency(ObservationEffect):
    """Offset between the camera's clock and the drive's."""

    id = "camera_latency"
    physics = "The pictures are stamped later (or earlier) than the moment they show, on the drive's clock."
    equation = "theta_measured(t) = theta(t - t_c)"
    parameters = (
        EffectParameter(
            "latency",
            "t_c",
            "s",
            0.0,
            -0.1,
            0.1,
            0.02,
            "one to several frames of 8.3 ms, one value per recording",
        ),
    )
    signature = (
        "Residual proportional to minus the angular rate; amplitude untouched; may differ from run to run."
    )
    confused_with = ("transport_delay", "charging_lag", "hydraulic_lag")
    separated_by = "A light on the gate signal in the camera's picture."
    citation = (
        "Kelly and Sukhatme, International Journal of Robotics Research 33 (2014) 1527 (temporal calibration)"
    )
    exclusive = "delay"

    def look_ahead(self, p: SimpleNamespace) -> float:
        """Frames stamped early show what comes after the last one."""
        return max(0.0, _MARGIN - p.latency)

    def angle(self, time: np.ndarray, sin_theta: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """The series at the moments the pictures show; before the start the body is at rest."""
        shown = np.clip(time - p.latency, time[0], time[-1])
        return CubicSpline(time, sin_theta)(shown)
