from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import DriveChannel, RecordingError


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
