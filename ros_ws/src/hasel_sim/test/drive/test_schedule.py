# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A commanded voltage as a step function."""

import numpy as np
from hasel_sim.drive.schedule import DriveSchedule

SCHEDULE = DriveSchedule(
    np.array([0.0, 0.5, 0.7, 1.0]), np.array([[3500.0, 0.0], [3500.0, 0.0], [0.0, -4500.0], [0.0, 0.0]])
)


def test_a_voltage_holds_to_the_next_row_and_is_zero_before_the_first():
    """Right-continuous, as the recordings say."""
    at = SCHEDULE.at(np.array([-0.1, 0.0, 0.69, 0.7, 2.0]))
    assert at.tolist() == [[0, 0], [3500, 0], [3500, 0], [0, -4500], [0, 0]]


def test_only_changes_are_switches_and_levels_are_magnitudes():
    """A repeated row switches nothing; a negative voltage has the level of its magnitude."""
    assert SCHEDULE.switches().tolist() == [0.0, 0.7, 1.0]
    assert SCHEDULE.levels().tolist() == [3500.0, 4500.0]


def test_sampling_keeps_both_sides_of_every_switch():
    """Equal times carry the value before and the value after."""
    time, voltage = SCHEDULE.sampled(np.array([0.1, 0.8]))
    jump = np.flatnonzero(time == 0.7)
    assert len(jump) == 2
    assert voltage[jump].tolist() == [[3500, 0], [0, -4500]]
    assert np.all(np.diff(time) >= 0)
