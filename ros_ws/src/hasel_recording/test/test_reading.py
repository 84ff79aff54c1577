# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from hasel_recording import RecordingError, RecordingWarning, read_recording, read_recordings, write_recording
from hasel_recording.reading import distinct_names


def test_unreadable_one_is_skipped_aloud(csv_file, tmp_path):
    """A broken recording among good ones is skipped, and a warning says why."""
    broken = tmp_path / "broken.csv"
    broken.write_text("time_s\n0\n")
    with pytest.warns(RecordingWarning, match="Skipped: .*broken.csv has no column 'sin_theta'"):
        recordings = read_recordings([broken, csv_file])
    assert [recording.name for recording in recordings] == ["run"]


def test_none_readable_is_an_error(tmp_path):
    """When nothing can be read, the reasons are the error."""
    with pytest.raises(RecordingError, match="There is no file"):
        read_recordings([tmp_path / "absent.csv"])
    with pytest.raises(RecordingError, match="No recording was given"):
        read_recordings([])


def test_misspelt_file_names_the_nearest(csv_file):
    """A file that is not there is answered with the one that is."""
    with pytest.raises(RecordingError, match=r"did you mean .*run\.csv"):
        read_recording(csv_file.with_name("rum.csv"))


def test_unknown_kind(tmp_path, driven):
    """Only CSV and MCAP are recordings, read or written."""
    with pytest.raises(RecordingError, match=r"give a \.mcap, \.db3 or \.csv file"):
        read_recording(tmp_path / "run.bag")
    with pytest.raises(RecordingError, match="neither MCAP nor CSV"):
        write_recording(driven, tmp_path / "run.bag")


def test_folder_of_ros2_bag_record(driven, tmp_path):
    """The folder that `ros2 bag record` makes stands for the one MCAP file in it."""
    write_recording(driven, tmp_path / "bag_0.mcap")
    assert len(read_recording(tmp_path).time_s) == 240
    write_recording(driven, tmp_path / "bag_1.mcap")
    with pytest.raises(RecordingError, match="holds 2 MCAP or SQLite files"):
        read_recording(tmp_path)


def test_place_that_cannot_be_written(driven, tmp_path):
    """A folder that does not exist is one sentence for either kind."""
    for name in ("run.csv", "run.mcap"):
        with pytest.raises(RecordingError, match="cannot be written"):
            write_recording(driven, tmp_path / "nowhere" / name)


@pytest.mark.parametrize(
    ("paths", "names"),
    [
        (["a/run.csv", "a/other.csv"], ["run", "other"]),
        (["a/run.csv", "b/run.csv", "b/other.csv"], ["a_run", "b_run", "other"]),
        (["run.csv", "run.mcap"], ["run.csv", "run.mcap"]),
        (["x/a/run.csv", "y/a/run.csv"], ["x_a_run", "y_a_run"]),
        (["run.csv", "run.csv"], ["run", "run_2"]),
    ],
)
def test_two_runs_of_one_name_stay_two(paths, names):
    """The shortest names that differ: with suffix, with folders; the same file twice is numbered."""
    assert distinct_names(paths) == names


ANGLES = "time_s,sin_theta\n" + "".join(f"{0.01 * n:.2f},0.{n:02d}\n" for n in range(50))


@pytest.fixture
def angles(tmp_path):
    """A recording without any drive."""
    path = tmp_path / "angles.csv"
    path.write_text(ANGLES)
    return path


def drive(tmp_path, text, name="valve.csv"):
    """A drive file with this text."""
    path = tmp_path / name
    path.write_text(text)
    return path


def test_the_drive_comes_from_a_file_of_its_own(angles, tmp_path):
    """Every row of the drive holds until its next; between frames its instants are kept exactly."""
    text = "time_s;pressure_chamber_mbar\n-1;0\n0,105;250\n0,33;0\n"
    run = read_recording(angles, drive=drive(tmp_path, text))
    assert run.drive_time_s.tolist() == [-1.0, 0.105, 0.33]
    assert run.drive_values[:, 0].tolist() == [0.0, 25000.0, 0.0]
    assert np.flatnonzero(run.drive_signal[:, 0])[[0, -1]].tolist() == [11, 32]
    assert run.channels[0].column == "pressure_chamber_pa"
    assert "the drive comes from valve.csv" in run.understood[-1]


def test_a_map_may_name_columns_of_both_files(angles, tmp_path):
    """What one file has not got is looked for in the other; a pair that neither has leaves a column missing."""
    angles.write_text(ANGLES.replace("time_s", "frame_time"))
    own = drive(tmp_path, "t;Druck mbar\n0;0\n0,105;250\n")
    mapping = {"time": "frame_time", "time_s": "t", "pressure_chamber": "Druck mbar"}
    assert read_recording(angles, mapping, own).drive_signal[-1].tolist() == [25000.0]
    with pytest.raises(RecordingError, match="has no drive, only t, Druck mbar"):
        read_recording(angles, {"time": "frame_time", "time_s": "t"}, own)


def test_the_header_may_name_the_file(angles, tmp_path):
    """The header line `drive` names a file beside the recording; a missing one is said."""
    angles.write_text("#drive: hv.csv\n" + ANGLES)
    with pytest.raises(RecordingError, match=r"there is no drive file .*hv\.csv"):
        read_recording(angles)
    drive(tmp_path, "time_s,voltage_upper_kv,voltage_lower_kv\n0,0,0\n0.2,5,0\n", "hv.csv")
    run = read_recording(angles)
    assert run.voltage[-1].tolist() == [5000.0, 0.0]
    assert "drive" not in run.metadata


def test_the_drive_of_another_recording_is_taken(angles, tmp_path):
    """An MCAP recording serves as the drive's file."""
    drive(tmp_path, "time_s,sin_theta,travel_tendon_mm\n0,0,0\n0.1,0,7\n", "other.csv")
    write_recording(read_recording(tmp_path / "other.csv"), tmp_path / "other.mcap")
    run = read_recording(angles, drive=tmp_path / "other.mcap")
    assert run.drive_signal[[0, 10], 0].tolist() == pytest.approx([0.0, 0.007])


def test_a_drive_that_does_not_reach_over_the_run_is_said(angles, tmp_path):
    """A late beginning, an early end under drive, and no overlap at all each get a sentence."""
    top = "time_s,pressure_chamber_mbar\n"
    with pytest.warns(RecordingWarning, match=r"begins at 0.2 s; before, nothing is taken to drive"):
        read_recording(angles, drive=drive(tmp_path, top + "0.2,250\n0.3,0\n"))
    with pytest.raises(RecordingError, match=r"begins at 70 s, when the recording has ended \(0.49 s\)"):
        read_recording(angles, drive=drive(tmp_path, top + "70,250\n"))
    long = "time_s,sin_theta\n" + "".join(f"{0.1 * n:.1f},0.1\n" for n in range(80))
    angles.write_text(long)
    with pytest.warns(
        RecordingWarning, match=r"ends at 1 s with 25000 Pa, which is taken to hold until 7.9 s"
    ):
        read_recording(angles, drive=drive(tmp_path, top + "0,0\n1,250\n"))


def test_one_drive_for_each_recording_or_one_for_all(angles, tmp_path):
    """Two files for three recordings are refused."""
    one = drive(tmp_path, "time_s,pressure_chamber_mbar\n0,250\n")
    assert all(run.driven for run in read_recordings([angles, angles], drives=[one]))
    with pytest.raises(RecordingError, match="2 drive files were given for 3 recordings"):
        read_recordings([angles] * 3, drives=[one, one])
