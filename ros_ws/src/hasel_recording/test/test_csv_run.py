# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import RecordingError, RecordingWarning, read_recording, write_recording


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
    "missing column": (
        "time_s,temperature\n0,21\n",
        r"no column 'sin_theta' .*only time_s, temperature.*--map",
    ),
    "no time": ("sin_theta\n0.1\n", r"no column 'time_s'"),
    "unknown unit": (
        "time_s,pressure_chamber_torr,sin_theta\n0,1,0.1\n",
        r"pressure_chamber_torr: 'torr' is no unit of pressure that is known, expected pa, hpa, kpa",
    ),
    "no channel": ("time_s,pressure_mbar,sin_theta\n0,1,0.1\n", r"such as pressure_main_mbar"),
    "angle of what": (
        "time_s,angle_deg\n0,1\n",
        r"is 'angle_deg' the bending angle\? Then call it theta_deg",
    ),
    "channel twice": (
        "time_s,voltage_upper_v,voltage_upper_kv,sin_theta\n0,1,0.001,0.1\n",
        r"voltage of upper \[V\] twice, as 'voltage_upper_v' and 'voltage_upper_kv'",
    ),
    "one marker": ("time_s,head_x_m,sin_theta\n0,1,0.1\n", r"no column 'head_y_m'"),
    "one in its unit": ("time_s,head_x_mm,sin_theta\n0,1,0.1\n", r"no column 'head_y_mm'"),
    "twice": ("time_s,time_s,sin_theta\n0,0,0.1\n", r"'time_s' twice"),
    "no time in a row": (GOOD + ",3500,0,0.1\n", r"line 3: a blank cell in column time_s"),
    "unknown voltage": (GOOD + "0.1,nan,0,0.1\n", r"line 3: voltage_upper_v is nan"),
    "no angle at all": ("time_s,sin_theta\n0,nan\n0.1,\n", r"no frame with an angle"),
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
    "no names": ("0,0.1\n0.01,0.2\n", r"has numbers where a row of column names is expected"),
    "no frames": ("time_s,sin_theta\n", r"no frames"),
    "binary": (b"\x89\xff\x00", r"not a text file"),
    "markers coincide": (
        "time_s,head_x_m,head_y_m,middle_x_m,middle_y_m,tail_x_m,tail_y_m\n0,0,0,0,0,1,0\n",
        r"no frame with an angle",
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


def test_semicolons_decimal_commas_and_units(tmp_path):
    """A spreadsheet's export: semicolons, decimal commas, padded header lines, milliseconds, degrees and kV."""
    path = tmp_path / "export.csv"
    path.write_bytes(
        "sep=;\n#model: swimmer;;;\n#Prüfer: Jörg;;;\ntime_ms;theta_deg;voltage_upper_kv;voltage_lower_kV\n"
        "0;0;0;0\n8,5;30;-5,5;1,5\n".encode("latin-1")
    )
    run = read_recording(path)
    assert run.metadata == {"model": "swimmer", "Prüfer": "Jörg"}
    assert run.time_s == pytest.approx([0, 0.0085])
    assert run.sin_theta == pytest.approx([0, 0.5])
    assert run.voltage.tolist() == [[0, 0], [-5500, 1500]]
    assert "cells are separated by semicolons" in run.understood


def test_a_blank_or_nan_angle_is_a_missing_one(tmp_path):
    """The frame stays with its drive, so that a switch in it is not moved."""
    path = tmp_path / "blank.csv"
    path.write_text("time_s,voltage_upper_v,sin_theta\n0,0,0.1\n0.01,0,\n0.02,5000,nan\n0.03,5000,0.2\n")
    run = read_recording(path)
    assert run.valid.tolist() == [True, False, False, True]
    assert run.drive_signal[:, 0].tolist() == [0, 0, 5000, 5000]
    assert run.drive_time_s is None


def test_frames_after_the_drives_end_are_left_out_aloud(tmp_path):
    """Rows at the end without a drive are not read, and said to be; a blank cell anywhere else is an error."""
    path = tmp_path / "ended.csv"
    path.write_text(GOOD + "0.1,0,3500,0.2\n0.2,,,0.3\n0.3,,nan,0.4\n")
    with pytest.warns(RecordingWarning, match="2 frames after the drive's end were left out"):
        run = read_recording(path)
    assert run.time_s.tolist() == [0.0, 0.1]
    assert run.voltage.tolist() == [[3500, 0], [0, 3500]]
    path.write_text(GOOD + "0.1,,,0.2\n0.2,0,0,0.3\n")
    with pytest.raises(RecordingError, match="a blank cell in column voltage_upper_v"):
        read_recording(path)


def test_any_number_of_markers(tmp_path):
    """Five markers in millimetres keep their order along the body; one that was not seen is NaN, its angle too."""
    names = ("head", "neck", "middle", "fin_root", "tail")
    top = "time_s," + ",".join(f"{name}_{axis}_mm" for name in names for axis in "xy")
    path = tmp_path / "five.csv"
    path.write_text(top + "\n0,0,0,5,0,10,0,15,0,20,10\n0.01,0,0,5,0,,,15,0,20,10\n")
    run = read_recording(path)
    assert run.marker_names == names
    assert run.markers[0].tolist() == [[0, 0], [0.005, 0], [0.01, 0], [0.015, 0], [0.02, 0.01]]
    assert run.sin_theta == pytest.approx([np.sqrt(0.5), np.nan], nan_ok=True)


def test_any_channel_of_any_quantity(tmp_path):
    """Any channel of any quantity is read; its limits are not the reader's business."""
    path = tmp_path / "arm.csv"
    path.write_text("time_s,pressure_chamber_mbar,travel_tendon_mm,sin_theta\n0,250,7,0\n0.01,99999,7,0.1\n")
    run = read_recording(path)
    assert [channel.column for channel in run.channels] == ["pressure_chamber_pa", "travel_tendon_m"]
    assert run.drive_signal[0] == pytest.approx([25000, 0.007])


@pytest.mark.parametrize(
    ("text", "encoding"),
    [
        ("time_s sin_theta\n0   0.1\n0.01 -0.2\n", "utf-8"),
        ("time_s\tsin_theta\n0\t0.1\n0.01\t-0.2\n", "utf-16"),
        ("TIME_S,Sin_Theta\n0,0.1\n0.01,-0.2\n", "utf-8-sig"),
        ('"time_s","sin_theta"\r\n0,0.1\r\n0.01,-0.2\r\n', "utf-8"),
        ("time_s,sin_theta,\n0,0.1,\n0.01,-0.2,\n", "utf-8"),
    ],
)
@pytest.mark.filterwarnings("ignore:.*column '' is not used")
def test_what_other_programs_write(tmp_path, text, encoding):
    """Blanks, tabs, quotes, capitals, a last empty column, any encoding: the same two frames."""
    path = tmp_path / "run.csv"
    path.write_bytes(text.encode(encoding))
    run = read_recording(path)
    assert (run.time_s.tolist(), run.sin_theta.tolist()) == ([0.0, 0.01], [0.1, -0.2])


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
