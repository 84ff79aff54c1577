# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from hasel_recording import RecordingError, read_recording
from hasel_recording.csv_columns import meant_names, parse_map


def test_pairs_are_read():
    """NAME=COLUMN pairs are separated by commas; a column's name may hold blanks and brackets."""
    assert parse_map("time=t [ms], sin_theta=Winkel (deg)") == {"time": "t [ms]", "sin_theta": "Winkel (deg)"}


@pytest.mark.parametrize(
    ("meant", "column", "full"),
    [
        ("time", "t", "time_s"),
        ("time", "t [ms]", "time_ms"),
        ("time_ms", "t", "time_ms"),
        ("sin_theta", "angle_deg", "theta_deg"),
        ("sin_theta", "angle", "sin_theta"),
        ("theta", "angle °", "theta_deg"),
        ("voltage_upper", "U1_kV", "voltage_upper_kv"),
        ("voltage_upper", "U1", "voltage_upper_v"),
        ("pressure_chamber_mbar", "p", "pressure_chamber_mbar"),
        ("tail_x", "tip x (mm)", "tail_x_mm"),
    ],
)
def test_a_unit_that_is_not_given_is_read_from_the_files_own_name(meant, column, full):
    """The name asked for gets its unit from itself, from the end of the file's column, or is in SI units."""
    assert meant_names({meant: column}, [column], "run.csv") == {column: full}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("time", "expected pairs such as time=t"),
        ("time=a,time=b", "'time' is named twice"),
        ("=t", "expected pairs"),
    ],
)
def test_what_is_no_pair_is_refused(text, said):
    """A missing equals sign or a name given twice is one sentence."""
    with pytest.raises(RecordingError, match=said):
        parse_map(text)


def test_a_labs_own_file_is_read_with_a_map(tmp_path):
    """Other names, degrees, milliseconds, kilovolts; the file's own sin_theta, which is not the angle, gives way."""
    path = tmp_path / "lab.csv"
    path.write_text("t [ms],angle_deg,sin_theta,HV1 kV\n0,0,9,0\n10,30,9,5.5\n")
    with pytest.warns(UserWarning, match="'sin_theta' is not used"):
        run = read_recording(path, parse_map("time=t [ms],sin_theta=angle_deg,voltage_upper=HV1 kV"))
    assert run.time_s.tolist() == [0.0, 0.01]
    assert run.sin_theta == pytest.approx([0.0, 0.5])
    assert run.drive_signal.tolist() == [[0.0], [5500.0]]
    assert [channel.column for channel in run.channels] == ["voltage_upper_v"]
    assert len(run.understood) == 4


def test_a_column_that_is_not_there_is_named(tmp_path):
    """A misspelt column of a map is refused with the nearest one."""
    path = tmp_path / "lab.csv"
    path.write_text("zeit,sin_theta\n0,0\n")
    with pytest.raises(RecordingError, match="no column 'zeitt' for time=zeitt: did you mean 'zeit'"):
        read_recording(path, {"time": "zeitt"})
    assert np.array_equal(read_recording(path, {"time": "zeit"}).time_s, [0.0])
