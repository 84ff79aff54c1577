# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Period, phase and switches of a drive."""

import numpy as np
import pytest
from hasel_sysid.residual_analysis.drive_cycle import drive_cycle


def _drive(upper, lower, periods=3, frequency=3.5, voltage=4500.0):
    time = np.arange(periods * 2) * 0.5 / frequency
    return time, voltage * np.column_stack([np.tile(upper, periods), np.tile(lower, periods)])


def test_both_muscles_in_turn():
    """From one take-over to the next but one is a period; the lower muscle has phase 0.5."""
    cycle = drive_cycle(*_drive([1, 0], [0, 1]))
    assert cycle.period == pytest.approx(1 / 3.5)
    assert cycle.side.tolist() == [1, -1, 1, -1, 1, -1]
    assert cycle.phase(np.array([0.75 / 3.5]))[0] == pytest.approx(0.75)


def test_one_muscle_only():
    """A single muscle's period is from onset to onset."""
    cycle = drive_cycle(*_drive([1, 0], [0, 0]))
    assert cycle.period == pytest.approx(1 / 3.5)


def test_frames_instead_of_switches():
    """A drive sampled at the frames has the same period to a frame, and a pause does not start a cycle."""
    time = np.arange(0, 2, 1 / 120)
    side = np.sin(2 * np.pi * 2.0 * (time - 0.25))
    voltage = 4500.0 * np.column_stack([side > 0, side < 0]) * (time >= 0.25)[:, None]
    cycle = drive_cycle(time, voltage)
    assert cycle.period == pytest.approx(0.5, abs=1 / 120)
    assert cycle.start == pytest.approx(0.25, abs=2 / 120)


def test_constant_drive_has_no_cycle():
    """A drive that never turns has no cycle."""
    assert drive_cycle(np.arange(5.0), np.tile([4500.0, 0.0], (5, 1))) is None


def test_alternating_polarity_is_the_same_drive():
    """The sign of the voltage does not matter: charge pulls either way."""
    time, voltage = _drive([1, 0], [0, 1])
    signs = np.array([1, -1, -1, 1, 1, -1])[:, None]
    assert drive_cycle(time, voltage * signs).side.tolist() == [1, -1, 1, -1, 1, -1]


def test_a_sensor_at_rest_starts_no_cycle():
    """A pressure that is filled and let out at 0.5 Hz, with a sensor's noise about zero between, repeats at 0.5 Hz."""
    time = np.arange(0, 10, 1 / 60)
    filled = 25000 * np.clip(np.sin(2 * np.pi * 0.5 * time), 0, None) ** 2
    noisy = np.round(filled + np.random.default_rng(8).normal(size=len(time)) * 60, -1)
    assert drive_cycle(time, noisy[:, None]).period == pytest.approx(2.0, rel=0.03)
    assert drive_cycle(time, (noisy - filled)[:, None] + 3000 * (time > 5)[:, None]) is None
