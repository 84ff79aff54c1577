# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Hydraulic lag."""

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule


def test_63_per_cent_after_one_release_time(response):
    """A contraction that is let go falls to 1/e of itself in one release time."""
    time = np.array([0.0, 0.0, 9.0, 9.0, 9.1])
    aim = np.array([0.0, 0.06, 0.06, 0.0, 0.0])[:, None] * np.ones(2)
    found = response("hydraulic_lag", time, aim, release_time=0.1)[:, 0]
    assert found == pytest.approx([0.0, 0.06, 0.06, 0.06, 0.06 * np.exp(-1)])


def test_a_steady_rise_runs_behind_by_the_rise_time(contraction_of):
    """While the sloped box rises, a first-order lag follows it one rise time later."""
    schedule = DriveSchedule(np.zeros(1), np.array([[5500.0, 0.0]]))
    times = np.linspace(0.0, 0.2, 81)
    plain = contraction_of(schedule, times)[:, 0]
    lagging = contraction_of(schedule, times, "hydraulic_lag", rise_time=0.02)[:, 0]
    assert (plain - lagging)[-1] == pytest.approx(0.264 * 0.02, rel=1e-3)
