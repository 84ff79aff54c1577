from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import RecordingError, read_recording, write_recording


def test_gives_back_the_same_numbers(driven, tmp_path):
    """What is written is read back to the last bit, header included."""
    run = replace(driven, sin_theta=np.sin(driven.time_s), drive_signal=driven.voltage / 3)
    write_recording(run, tmp_path / "run.csv")
    again = read_recording(tmp_path / "run.csv")
    for name in ("time_s", "sin_theta", "voltage"):
        np.testing.assert_array_equal(getattr(again, name), getattr(run, name))
    assert again.metadata == run.metadata


def test_a_frame_without_an_angle_is_a_blank_cell(driven, tmp_path):
    """A lost frame keeps its place in time."""
    sin_theta = driven.sin_theta.copy()
    sin_theta[[3, 7]] = np.nan
    write_recording(replace(driven, sin_theta=sin_theta), tmp_path / "run.csv")
    np.testing.assert_array_equal(read_recording(tmp_path / "run.csv").sin_theta, sin_theta)


def test_switching_between_frames_goes_into_a_file_of_its_own(driven, tmp_path):
    """Instants of switching that are not frames are kept in a drive file, which the header names."""
    exact = replace(
        driven, drive_time_s=np.array([0.0, 0.2501]), drive_values=np.array([[3500.0, 0], [0, 0]])
    )
    write_recording(exact, tmp_path / "run.csv")
    assert "#drive: run_drive.csv" in (tmp_path / "run.csv").read_text()
    again = read_recording(tmp_path / "run.csv")
    assert again.drive_time_s.tolist() == [0.0, 0.2501]
    assert again.drive_values.tolist() == [[3500, 0], [0, 0]]
    assert again.metadata == driven.metadata


def test_header_line_with_a_line_break_is_refused(driven, tmp_path):
    """A header value that would break the file's lines is an error."""
    with pytest.raises(RecordingError, match="'note' of driven does not fit"):
        write_recording(replace(driven, metadata={"note": "a\nb"}), tmp_path / "run.csv")
