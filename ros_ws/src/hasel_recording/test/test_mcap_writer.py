from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import read_recording, write_recording
from hasel_recording.topics import MARKERS, MEASURED, STATE
from rosbags.highlevel import AnyReader

ARRAYS = ("time_s", "sin_theta", "voltage", "markers", "drive_time_s", "drive_values")


def assert_same(again, original):
    """Compare all that a run holds, number by number."""
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(again, name), getattr(original, name), err_msg=name)
    assert (again.metadata, again.marker_unit) == (original.metadata, original.marker_unit)


def test_gives_back_the_same_run(driven, tmp_path):
    """What is written is read back bit by bit, header included."""
    write_recording(driven, tmp_path / "run.mcap")
    assert_same(read_recording(tmp_path / "run.mcap"), driven)


@pytest.mark.parametrize("unit", ["m", "px"])
def test_markers_and_times_before_zero(driven, unit, tmp_path):
    """Markers in either unit, lost frames and times before zero survive."""
    markers = np.random.default_rng(1).normal(size=(240, 3, 2))
    sin_theta = np.where(np.arange(240) == 5, np.nan, driven.sin_theta)
    time_s = np.round(driven.time_s - 0.5, 6)
    run = replace(
        driven, time_s=time_s, sin_theta=sin_theta, markers=markers, marker_unit=unit, drive_signal=None
    )
    write_recording(run, tmp_path / "run.mcap")
    assert_same(read_recording(tmp_path / "run.mcap"), run)


def test_exact_switching_survives(driven, tmp_path):
    """Instants of switching between the frames are kept beside the frames' voltages."""
    drive = {
        "drive_time_s": np.array([0.0, 0.0101, 1.5]),
        "drive_values": np.array([[0.0, 0], [5000, 0], [0, 9000]]),
    }
    held = np.searchsorted(drive["drive_time_s"], driven.time_s, side="right") - 1
    run = replace(driven, drive_signal=drive["drive_values"][held], **drive)
    write_recording(run, tmp_path / "run.mcap")
    assert_same(read_recording(tmp_path / "run.mcap"), run)


def test_independent_reader_gives_the_same_numbers(driven, tmp_path):
    """rosbags reads the numbers that were written, on the topics and types of the stack."""
    markers = np.arange(240 * 6, dtype=float).reshape(240, 3, 2)
    write_recording(replace(driven, markers=markers), tmp_path / "run.mcap")
    columns: dict[str, list] = {STATE: [], MEASURED: [], MARKERS: []}
    with AnyReader([tmp_path / "run.mcap"]) as reader:
        for connection, _, data in reader.messages():
            columns[connection.topic].append(reader.deserialize(data, connection.msgtype))
    stamps = [(m.header.stamp.sec * 10**9 + m.header.stamp.nanosec) / 1e9 for m in columns[MEASURED]]
    assert stamps == driven.time_s.tolist()
    assert [m.sin_theta for m in columns[MEASURED]] == driven.sin_theta.tolist()
    assert [m.commanded_voltage.tolist() for m in columns[STATE]] == driven.voltage.tolist()
    points = [[[pose.position.x, pose.position.y] for pose in m.poses] for m in columns[MARKERS]]
    assert points == markers.tolist()
