import numpy as np
import pytest
from hasel_recording import RecordingError, RecordingWarning, read_recording


def test_reads_numbers_and_header(csv_file):
    """Header lines, times, signed voltages of both sides and the angle arrive as written."""
    recording = read_recording(csv_file)
    assert recording.metadata == {"model": "swimmer", "operator": "A. Person, evening"}
    assert recording.time_s.tolist() == [0.0, 0.008333, 0.016667]
    assert recording.voltage.tolist() == [[3500, 0], [3500, 0], [0, -3500.5]]
    assert recording.sin_theta.tolist() == [-0.002241, 0.007149, 1.25e-05]
    assert recording.name == "run"
    assert recording.markers is None


def test_passive_body_has_no_voltage(tmp_path):
    """Without voltage columns the run is passive: its drive is 0 V."""
    path = tmp_path / "passive.csv"
    path.write_text("time_s,sin_theta\n0,0.1\n0.01,0.2\n")
    recording = read_recording(path)
    assert recording.voltage is None
    assert not recording.drive()[1].any()


def test_markers_in_metres_give_the_angle(tmp_path):
    """Marker columns stand in for sin_theta: here a tail 30 degrees up."""
    path = tmp_path / "markers.csv"
    tail = f"{2 + np.cos(np.pi / 6)},{np.sin(np.pi / 6)}"
    path.write_text(f"time_s,head_x_m,head_y_m,middle_x_m,middle_y_m,tail_x_m,tail_y_m\n0,0,0,2,0,{tail}\n")
    recording = read_recording(path)
    assert recording.sin_theta == pytest.approx([0.5])
    assert recording.markers.shape == (1, 3, 2)


def test_markers_in_pixels_count_y_downwards(tmp_path):
    """In an image y points down, so a tail at larger y bends to the negative side."""
    path = tmp_path / "pixels.csv"
    path.write_text(
        "time_s,head_x_px,head_y_px,middle_x_px,middle_y_px,tail_x_px,tail_y_px\n0,0,100,50,100,100,150\n"
    )
    recording = read_recording(path)
    assert recording.sin_theta == pytest.approx([-np.sqrt(0.5)])
    assert recording.marker_unit == "px"


def test_foreign_column_is_named_and_ignored(tmp_path):
    """A column that means nothing here is left out with a warning, whatever it holds."""
    path = tmp_path / "extra.csv"
    path.write_text("time_s,sin_theta,operator\n0,0.1,Ann\n")
    with pytest.warns(RecordingWarning, match="'operator' is not used"):
        assert read_recording(path).sin_theta.tolist() == [0.1]


GOOD = "time_s,voltage_upper_v,voltage_lower_v,sin_theta\n0,3500,0,0.1\n"
BAD_FILES = {
    "misspelt column": (
        "time_s,sin_teta\n0,0.1\n",
        r"'sin_teta' that is not known: did you mean 'sin_theta'",
    ),
    "missing column": ("time_s,temperature\n0,21\n", r"no column 'sin_theta', only time_s, temperature"),
    "no time": ("sin_theta\n0.1\n", r"no column 'time_s'"),
    "one voltage": ("time_s,voltage_upper_v,sin_theta\n0,1,0.1\n", r"no column 'voltage_lower_v'"),
    "one marker": ("time_s,head_x_m,sin_theta\n0,1,0.1\n", r"no column 'head_y_m'"),
    "twice": ("time_s,time_s,sin_theta\n0,0,0.1\n", r"'time_s' twice"),
    "NaN": (GOOD + "0.1,3500,0,nan\n", r"line 3: sin_theta is nan"),
    "infinite": (GOOD + "0.1,inf,0,0.1\n", r"line 3: voltage_upper_v is inf"),
    "text": (
        "#model: beam\n" + GOOD + "\n0.1,3500,O,0.1\n",
        r"line 5: 'O' in column voltage_lower_v is not a",
    ),
    "unsorted": (GOOD + "0.2,0,0,0.1\n0.1,0,0,0.1\n", r"line 4: time_s 0.1 does not come after 0.2"),
    "same time": (GOOD + "0,0,0,0.1\n", r"line 3: time_s 0 does not come after 0"),
    "cells": (GOOD + "0.1,3500,0.1\n", r"line 3 has 3 cells where the top row names 4"),
    "empty": ("", r"is empty"),
    "header only": ("#model: beam\n", r"is empty"),
    "no frames": ("time_s,sin_theta\n", r"no frames"),
    "binary": (b"\x89\xff\x00", r"not a text file"),
    "markers coincide": (
        "time_s,head_x_m,head_y_m,middle_x_m,middle_y_m,tail_x_m,tail_y_m\n0,0,0,0,0,1,0\n",
        r"line 2: two markers coincide",
    ),
}


@pytest.mark.parametrize("name", BAD_FILES)
def test_bad_file_is_one_sentence(name, tmp_path):
    """What is wrong with a file is said in one line with the place where it is wrong."""
    content, message = BAD_FILES[name]
    path = tmp_path / "bad.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(RecordingError, match=message) as caught:
        read_recording(path)
    assert "\n" not in str(caught.value)
