# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Gain drift."""

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule


def test_the_plateau_falls_in_proportion_to_time(contraction_of):
    """At 3 % per second, 5 s after the start of the run 85 % of the contraction is left."""
    start = 2.0
    schedule = DriveSchedule(np.array([start]), np.array([[5500.0, 4500.0]]))
    times = start + np.array([0.0, 1.0, 5.0])
    plain = contraction_of(schedule, times)
    drifting = contraction_of(schedule, times, "gain_drift", rate=0.03)
    assert drifting[1:] == pytest.approx(plain[1:] * np.array([[0.97], [0.85]]))
