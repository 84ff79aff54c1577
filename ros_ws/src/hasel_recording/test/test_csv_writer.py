from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import RecordingError, RecordingWarning, read_recording, write_recording


def test_gives_back_the_same_numbers(driven, tmp_path):
    """What is written is read back to the last bit, header included."""
    run = replace(driven, sin_theta=np.sin(driven.time_s), drive_signal=driven.voltage / 3)
    write_recording(run, tmp_path / "run.csv")
    again = read_recording(tmp_path / "run.csv")
    for name in ("time_s", "sin_theta", "voltage"):
        np.testing.assert_array_equal(getattr(again, name), getattr(run, name))
    assert again.metadata == run.metadata


def test_frames_without_an_angle_are_left_out_aloud(driven, tmp_path):
    """A CSV file cannot hold a lost frame: it is left out and counted in a warning."""
    sin_theta = driven.sin_theta.copy()
    sin_theta[[3, 7]] = np.nan
    with pytest.warns(RecordingWarning, match="2 frames without an angle"):
        write_recording(replace(driven, sin_theta=sin_theta), tmp_path / "run.csv")
    assert len(read_recording(tmp_path / "run.csv").time_s) == len(driven.time_s) - 2


def test_switching_between_frames_is_rounded_aloud(driven, tmp_path):
    """Instants of switching that are not frames cannot be kept in CSV, which is said."""
    exact = replace(
        driven, drive_time_s=np.array([0.0, 0.2501]), drive_values=np.array([[3500.0, 0], [0, 0]])
    )
    with pytest.warns(RecordingWarning, match="each switch moves to the next frame"):
        write_recording(exact, tmp_path / "run.csv")


def test_header_line_with_a_line_break_is_refused(driven, tmp_path):
    """A header value that would break the file's lines is an error."""
    with pytest.raises(RecordingError, match="'note' of driven does not fit"):
        write_recording(replace(driven, metadata={"note": "a\nb"}), tmp_path / "run.csv")
