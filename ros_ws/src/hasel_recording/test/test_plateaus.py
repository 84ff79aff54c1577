# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What acts, of a drive as people measure it."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import DriveChannel, read_recording, write_recording

TIME = np.arange(240) / 120.0
SWITCHED = np.where(np.mod(TIME, 0.5) < 0.25, 3500.0, 0.0)
PRESSURE = (DriveChannel("chamber", "pressure", "Pa"),)


def measured(driven, signal):
    """The run, driven by one channel [n] that a sensor gave."""
    return replace(driven, channels=PRESSURE, drive_signal=np.asarray(signal, dtype=float)[:, None])


@pytest.mark.parametrize("ripple", [0.4, 6.0, 60.0, 175.0])
@pytest.mark.parametrize("rounding", [0, 2])
def test_plateaus_are_found_whatever_the_noise(driven, ripple, rounding):
    """Two levels under 0.01 to 5 % of ripple, rounded or not, act as the two levels, and it is said."""
    noise = np.random.default_rng(1).normal(size=240) * ripple
    run = measured(driven, np.round(SWITCHED + noise, rounding))
    acting = run.drive()[1][:, 0]
    assert len(np.unique(acting)) == 2
    np.testing.assert_allclose(acting, SWITCHED, atol=ripple / 3)
    (said,) = run.ripple
    assert "ripples by" in said and "taken for what acts" in said


def test_flicker_of_the_last_digit_is_no_level(driven):
    """A converter that shows its last digit now and then gives two levels, not five."""
    flicker = (np.random.default_rng(2).random(240) < 0.2) * np.random.default_rng(3).choice([-5.0, 5.0], 240)
    np.testing.assert_array_equal(np.unique(measured(driven, SWITCHED + flicker).drive()[1]), [0.0, 3500.0])


def test_a_slewing_supply_switches_halfway(driven):
    """One row on the way between two levels belongs to the nearer one."""
    slewed = SWITCHED.copy()
    slewed[30::60] = 1200.0
    noise = np.random.default_rng(4).normal(size=240) * 3.0
    np.testing.assert_array_equal(np.unique(measured(driven, slewed + noise).drive()[1]), [0.0, 3500.0])


@pytest.mark.parametrize(
    "signal",
    [
        SWITCHED,
        np.where(TIME < 1, 3500.0, 3510.0),
        2500 + 2500 * np.sin(2 * np.pi * 2 * TIME),
        3500 + 50 * np.sin(2 * np.pi * 2 * TIME),
        2000 * TIME,
        np.round(2000 * TIME / 50) * 50,
        2000 * TIME + np.random.default_rng(5).normal(size=240) * 20,
        25000 * (1 - np.exp(-np.mod(TIME, 1.0) / 0.2)) + np.random.default_rng(6).normal(size=240) * 100,
    ],
    ids=["exact", "near levels", "sine", "modulated", "ramp", "staircase", "noisy ramp", "filling chamber"],
)
def test_what_is_exact_or_continuous_is_the_drive(driven, signal):
    """Commands, and what goes through a continuum, act exactly as they were recorded, and nothing is said."""
    run = measured(driven, signal)
    np.testing.assert_array_equal(run.drive()[1][:, 0], signal)
    assert run.ripple == ()


@pytest.mark.parametrize("suffix", [".csv", ".mcap"])
def test_converting_keeps_the_ripple(driven, tmp_path, suffix):
    """What was recorded is written, not what acts."""
    noisy = SWITCHED + np.random.default_rng(7).normal(size=240) * 6.0
    write_recording(measured(driven, noisy), tmp_path / f"run{suffix}")
    np.testing.assert_array_equal(read_recording(tmp_path / f"run{suffix}").recorded_drive()[1][:, 0], noisy)
