# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Recordings as messages in order of time."""

from pathlib import Path

import numpy as np
import pytest
from hasel_bringup.errors import BringupError
from hasel_bringup.replay import one_after_the_other, timeline
from hasel_recording import DriveChannel, Recording, RecordingError, read_recording

TIME = np.array([0.0, 0.1, 0.2])
VOLTAGE = np.array([[10.0, 0.0], [10.0, 0.0], [0.0, -20.0]])


def test_a_frame_carries_its_voltage_and_angle():
    """Stamps, voltages and angles are those of the recording."""
    frames = timeline(Recording("run", TIME, np.array([0.0, np.nan, 0.3]), VOLTAGE))
    assert [frame.stamp_ns for frame in frames] == [0, 100_000_000, 200_000_000]
    assert [frame.voltage for frame in frames] == [(10.0, 0.0), (10.0, 0.0), (0.0, -20.0)]
    assert frames[2].sin_theta == 0.3
    assert np.isnan(frames[1].sin_theta)


@pytest.mark.filterwarnings("ignore::hasel_recording.RecordingWarning")  # of the frame before the first state
def test_a_bag_of_old_messages_is_replayed():
    """Every frame and every voltage of a bag from before the muscles had names goes onto the topics of today."""
    old = Path(__file__).parents[2] / "hasel_recording" / "test" / "recordings" / "pairs_of_voltages.mcap"
    recording = read_recording(old)
    frames = timeline(recording)
    assert [
        frame.sin_theta for frame in frames if frame.sin_theta is not None
    ] == recording.sin_theta.tolist()
    assert {frame.voltage for frame in frames} >= {(4500.0, 0.0), (0.0, 4500.0)}


def test_a_switch_between_frames_is_a_state_of_its_own():
    """It comes at its exact time and without an angle; frames hold the voltage in force."""
    recording = Recording(
        "run", TIME, np.zeros(3), VOLTAGE, drive_time_s=np.array([0.05, 0.15]), drive_values=VOLTAGE[[0, 2]]
    )
    frames = timeline(recording)
    assert [(frame.stamp_ns // 10**6, frame.voltage[0], frame.sin_theta is None) for frame in frames] == [
        (0, 0.0, False),
        (50, 10.0, True),
        (100, 10.0, False),
        (150, 0.0, True),
        (200, 0.0, False),
    ]


def test_a_passive_body_is_replayed_at_zero_volt():
    """The simulator needs states to follow, also of a body without muscles."""
    frames = timeline(Recording("beam", TIME, np.zeros(3)))
    assert [frame.voltage for frame in frames] == [(0.0, 0.0)] * 3


def test_only_the_rigs_two_voltages_are_replayed():
    """The state that is published has two voltages: a run of other channels is refused with one sentence."""
    chamber = (DriveChannel("chamber", "pressure", "Pa"),)
    with pytest.raises(RecordingError, match="is driven by pressure_chamber_pa, where voltage_upper_v and"):
        timeline(Recording("arm", TIME, np.zeros(3), VOLTAGE[:, :1], channels=chamber))


def test_frames_before_the_release_are_left_out():
    """`compare` does not use them either; the release itself is a state."""
    frames = timeline(Recording("beam", TIME, np.zeros(3), metadata={"initial_time_s": "0.05"}))
    assert [(f.stamp_ns // 10**6, f.sin_theta is None) for f in frames] == [
        (50, True),
        (100, False),
        (200, False),
    ]
    with pytest.raises(BringupError, match="initial_time_s"):
        timeline(Recording("beam", TIME, np.zeros(3), metadata={"initial_time_s": "7"}))


def test_further_recordings_follow_after_a_pause():
    """The first keeps its stamps; every later one keeps its steps."""
    frames = timeline(Recording("run", TIME, np.zeros(3), VOLTAGE))
    first, second, third = one_after_the_other([frames, frames, frames])
    assert first == frames
    assert (
        second[0].stamp_ns - first[-1].stamp_ns == third[0].stamp_ns - second[-1].stamp_ns == 10_000_000_000
    )
    assert [f.stamp_ns - second[0].stamp_ns for f in second] == [f.stamp_ns for f in frames]
