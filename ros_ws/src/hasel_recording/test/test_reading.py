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
