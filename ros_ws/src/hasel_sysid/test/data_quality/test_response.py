# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A drive whose frequency is not that of the response."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_sysid.data_quality import check_recording
from hasel_sysid.data_quality.response import check_drive_frequency, explained


def _slower(recording, ratio: float):
    """The response of a run at a share of the drive's frequency."""
    time = recording.time_s
    return replace(recording, sin_theta=np.interp(ratio * time, time, recording.sin_theta))


@pytest.fixture
def long_run(made_recording, angle):
    """Sixteen periods of 2 Hz."""
    short = made_recording()
    time = np.arange(0.0, 8.0, 1 / 120)
    noise = 0.002 * np.random.default_rng(1).standard_normal(len(time))
    drive = np.zeros((len(time), 2))
    drive[np.mod(time, 0.5) < 0.25, 0] = 4500.0
    drive[np.mod(time, 0.5) >= 0.25, 1] = 4500.0
    return replace(short, time_s=time, sin_theta=angle(time, 2.0) + noise, drive_signal=drive)


@pytest.mark.parametrize("ratio", [0.75, 0.6, 0.9])
def test_a_response_at_another_frequency_is_an_error_with_its_ratio(long_run, ratio):
    """Such as a tail that beats at three quarters of the motor's named frequency."""
    (found,) = check_drive_frequency(_slower(long_run, ratio))
    assert found.fault == "frequency of the drive" and found.severity.value == "error"
    assert found.number == pytest.approx(ratio, abs=0.02)
    assert "of the 2 Hz of the drive" in found.sentence
    assert found.fault in {f.fault for f in check_recording(_slower(long_run, ratio))}


@pytest.mark.parametrize("cycles", [3.75, 4.5, 9.0])
def test_a_few_cycles_are_enough_and_the_ratio_is_exact(long_run, cycles):
    """Of a film of five seconds: less than three beats."""
    keep = long_run.time_s < 0.5 * cycles
    short = replace(long_run, time_s=long_run.time_s[keep], drive_signal=long_run.drive_signal[keep])
    slower = replace(short, sin_theta=_slower(long_run, 0.75).sin_theta[keep])
    (found,) = check_drive_frequency(slower)
    assert found.number == pytest.approx(0.75, abs=0.011)
    assert check_drive_frequency(replace(short, sin_theta=long_run.sin_theta[keep])) == []


def test_a_response_with_the_drives_period_is_left_in_peace(long_run):
    """Also where its double dominates, where it is mostly noise, or too short to tell."""
    assert check_drive_frequency(long_run) == []
    time = long_run.time_s
    doubled = 0.02 * np.sin(4 * np.pi * time) + 0.1 * np.sin(8 * np.pi * time)
    noise = 0.1 * np.random.default_rng(2).standard_normal(len(time))
    for series in (doubled, noise):
        assert check_drive_frequency(replace(long_run, sin_theta=series)) == []
    short = 150
    few = replace(
        _slower(long_run, 0.75),
        time_s=time[:short],
        sin_theta=_slower(long_run, 0.75).sin_theta[:short],
        drive_signal=long_run.drive_signal[:short],
    )
    assert check_drive_frequency(few) == []


def test_swinging_out_is_no_other_frequency(long_run):
    """After the end of a short drive a body swings as it likes, for nearly as long as it was driven."""
    time = long_run.time_s[:420]
    ringing = 0.2 * np.sin(4 * np.pi * time) * np.where(time < 2.0, 1.0, 0.0)
    ringing += 0.2 * np.sin(2.4 * np.pi * (time - 2.0)) * (time >= 2.0)
    drive = np.where(time[:, None] < 2.0, long_run.drive_signal[:420], 0.0)
    short = replace(long_run, time_s=time, sin_theta=ringing, drive_signal=drive)
    assert check_drive_frequency(short) == []


def test_a_drive_that_never_acts_is_left_in_peace(long_run):
    """Voltages that are zero throughout."""
    assert check_drive_frequency(replace(long_run, drive_signal=0.0 * long_run.drive_signal)) == []


def test_explained_variance():
    """All of a square wave's first harmonics at its frequency, little beside it."""
    time = np.arange(0.0, 6.0, 1 / 100)
    wave = np.sin(2 * np.pi * 1.5 * time) + 0.3 * np.cos(6 * np.pi * 1.5 * time)
    assert explained(time, wave, 1.5) == pytest.approx(1.0)
    assert explained(time, wave, 2.0) < 0.2
