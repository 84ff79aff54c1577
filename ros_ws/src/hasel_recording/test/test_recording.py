# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A run, values that hold until the next, and the angle of three markers."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hasel_recording import DriveChannel, RecordingError, read_recording, sin_theta_from_markers
from hasel_recording.recording import held, row_in_force, turn_between
from hypothesis import given
from hypothesis import strategies as st


def test_prints_as_a_sentence(driven):
    """A run says how long it is, how fast, how strongly driven and how far it bends."""
    assert str(driven) == "driven: 240 frames in 1.99 s (120 frames/s), up to 3500 V, |sin θ| up to 0.1"


def test_lost_frames_are_counted(driven):
    """Frames without an angle are named and do not spoil the extremes."""
    run = replace(driven, sin_theta=np.where(np.arange(240) < 2, np.nan, driven.sin_theta))
    assert "2 without an angle" in str(run)
    assert run.valid.sum() == 238


def test_drive_prefers_the_exact_instants(driven):
    """The drive is the instants of switching where they are known, else the frames."""
    assert driven.drive()[0] is driven.time_s
    run = replace(driven, drive_time_s=np.array([0.1]), drive_values=np.array([[1.0, 2.0]]))
    assert run.drive()[0].tolist() == [0.1]


def test_any_channel_may_drive_a_body(driven):
    """A pressure run prints with its unit; who needs the rig's two voltages gets one sentence."""
    chamber = DriveChannel("chamber", "pressure", "Pa")
    run = replace(driven, drive_signal=np.full((240, 1), 25000.0), channels=(chamber,))
    assert "up to 25000 Pa" in str(run)
    assert run.drive()[1].shape == (240, 1)
    with pytest.raises(RecordingError, match="driven by pressure_chamber_pa, where voltage_upper_v"):
        _ = run.voltage


def test_instants_come_with_what_was_then(driven):
    """Times of the drive or of the simulated angle without values, or values without times, are refused."""
    for name in ("drive_time_s", "simulated_time_s", "simulated_sin_theta"):
        alone = dict.fromkeys(("drive_time_s", "drive_values", "simulated_time_s", "simulated_sin_theta"))
        with pytest.raises(RecordingError, match="but not both"):
            replace(driven, **{**alone, name: np.zeros(3)})


def test_every_signal_and_marker_has_a_name(driven):
    """Drive and markers need one column per name."""
    with pytest.raises(RecordingError, match="3 signals, but names 2 channels"):
        replace(driven, drive_signal=np.zeros((240, 3)))
    with pytest.raises(RecordingError, match="4 markers, but names 3"):
        replace(driven, markers=np.zeros((240, 4, 2)))


def test_the_angles_markers_are_chosen_by_name(driven):
    """Of any number of markers head, middle and tail are those of the angle."""
    markers = np.arange(240 * 8.0).reshape(240, 4, 2)
    run = replace(driven, markers=markers, marker_names=("head", "neck", "middle", "tail"))
    assert np.array_equal(run.angle_markers, markers[:, [0, 2, 3]])
    assert replace(run, marker_names=("a", "b", "c", "d")).angle_markers is None


TIMES = np.array([1.0, 2.0, 4.0])


def test_a_value_holds_from_its_own_instant_to_the_next():
    """At the instant itself the new one is in force; nothing is before the first, and the last one stays."""
    at = np.array([0.5, 1.0, 1.999, 2.0, 4.0, 99.0])
    assert row_in_force(TIMES, at).tolist() == [-1, 0, 0, 1, 2, 2]
    assert held(TIMES, np.array([3.0, 5.0, 7.0]), at).tolist() == [0, 3, 3, 5, 7, 7]


def test_several_channels_and_a_value_that_is_not_known():
    """Rows go together, and NaN is in force like any other."""
    values = np.array([[1.0, 2.0], [np.nan, np.nan], [3.0, 4.0]])
    found = held(TIMES, values, np.array([0.0, 1.5, 2.5, 5.0]))
    np.testing.assert_array_equal(found, [[0, 0], [1, 2], [np.nan, np.nan], [3, 4]])


def test_one_instant():
    """As a waveform asks."""
    assert row_in_force(TIMES, 2.5) == 1


@given(st.lists(st.floats(0.0, 5.0), min_size=1, max_size=20))
def test_the_last_of_all_that_came_so_far_is_in_force(at):
    """As one would look it up by hand."""
    values = np.array([3.0, 5.0, 7.0])
    by_hand = [([0.0, *values[t >= TIMES]])[-1] for t in at]
    assert held(TIMES, values, np.array(at)).tolist() == by_hand


REAL_BEAM = Path(__file__).resolve().parents[4].parent / "shared" / "data" / "real_beam"


@pytest.mark.parametrize("degrees", [-170, -90, -30, 0, 30, 90, 150])
def test_angle_between_two_segments(degrees):
    """Two segments of any lengths, position and orientation give the sine of the angle between them."""
    angle, heading = np.deg2rad(degrees), 0.7
    head = np.array([3.0, -2.0])
    middle = head + 0.05 * np.array([np.cos(heading), np.sin(heading)])
    tail = middle + 0.09 * np.array([np.cos(heading + angle), np.sin(heading + angle)])
    assert sin_theta_from_markers(np.array([[head, middle, tail]])) == pytest.approx(
        [np.sin(angle)], abs=1e-12
    )


def test_any_number_of_axes_comes_before():
    """One frame, frames of a run, or runs of frames."""
    markers = np.random.default_rng(0).normal(size=(4, 5, 3, 2))
    found = sin_theta_from_markers(markers)
    assert found.shape == (4, 5)
    assert found[2].tolist() == sin_theta_from_markers(markers[2]).tolist()
    assert found[2, 3] == sin_theta_from_markers(markers[2, 3])


@pytest.mark.parametrize("degrees", [-170, -90, 0, 30, 150])
def test_turn_tells_which_way_round(degrees):
    """The angle beyond a right one too, which its sine alone does not tell."""
    angle = np.deg2rad(degrees)
    sine, turn = turn_between(np.array([2.0, 0.0]), 0.5 * np.array([np.cos(angle), np.sin(angle)]))
    assert (sine, turn) == (pytest.approx(np.sin(angle)), pytest.approx(angle))


def test_coinciding_markers_have_no_angle():
    """A marker on top of another one gives NaN in that frame only."""
    frames = np.array([[[0, 0], [0, 0], [1, 0]], [[0, 0], [1, 0], [2, 0]]], dtype=float)
    assert np.isnan(sin_theta_from_markers(frames)).tolist() == [True, False]


@pytest.mark.skipif(not REAL_BEAM.is_dir(), reason="the measured beam's files are not beside the repository")
def test_measured_beam():
    """On the measured beam the markers give the angle that its authors computed from them."""
    recording = read_recording(REAL_BEAM / "gravity_a.csv")
    assert sin_theta_from_markers(recording.markers) == pytest.approx(recording.sin_theta, abs=2e-7)
