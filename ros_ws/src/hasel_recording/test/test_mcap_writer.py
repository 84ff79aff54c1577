from dataclasses import replace

import numpy as np
import pytest
from hasel_common.topics import DRIVE, MEASURED, STATE
from hasel_recording import DriveChannel, read_recording, write_recording
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
    columns: dict[str, list] = {STATE: [], MEASURED: []}
    with AnyReader([tmp_path / "run.mcap"]) as reader:
        for connection, _, data in reader.messages():
            columns[connection.topic].append(reader.deserialize(data, connection.msgtype))
    stamps = [(m.header.stamp.sec * 10**9 + m.header.stamp.nanosec) / 1e9 for m in columns[MEASURED]]
    assert stamps == driven.time_s.tolist()
    assert [m.sin_theta for m in columns[MEASURED]] == driven.sin_theta.tolist()
    assert [m.commanded_voltage.tolist() for m in columns[STATE]] == driven.voltage.tolist()
    points = [np.column_stack([m.marker_x_m, m.marker_y_m]).tolist() for m in columns[MEASURED]]
    assert points == markers.tolist()


@pytest.mark.parametrize("kind", [".mcap", ".csv"])
def test_any_channels_and_markers_survive(driven, kind, tmp_path):
    """Two channels of other quantities, which switch between frames, and four markers come back bit by bit."""
    channels = (DriveChannel("chamber", "pressure", "Pa"), DriveChannel("tendon", "travel", "m"))
    run = replace(
        driven,
        channels=channels,
        drive_signal=np.column_stack([np.repeat([0.0, 1 / 3 * 1e5], 120), np.repeat([0.0, 0.0071], 120)]),
        drive_time_s=np.array([0.0, 0.9999]),
        drive_values=np.array([[0.0, 0.0], [1 / 3 * 1e5, 0.0071]]),
        markers=np.random.default_rng(2).normal(size=(240, 4, 2)),
        marker_names=("head", "middle", "fin_root", "tail"),
    )
    write_recording(run, tmp_path / f"run{kind}")
    again = read_recording(tmp_path / f"run{kind}")
    for name in ("time_s", "sin_theta", "drive_signal", "drive_time_s", "drive_values", "markers"):
        np.testing.assert_array_equal(getattr(again, name), getattr(run, name), err_msg=name)
    assert (again.channels, again.marker_names) == (channels, run.marker_names)


def test_other_channels_have_a_topic_of_their_own(driven, tmp_path):
    """An independent reader finds names, units and values of a pressure on /hasel/drive, and no supply state."""
    chamber = DriveChannel("chamber", "pressure", "Pa")
    write_recording(
        replace(driven, channels=(chamber,), drive_signal=driven.voltage[:, :1]), tmp_path / "run.mcap"
    )
    with AnyReader([tmp_path / "run.mcap"]) as reader:
        found = [(c.topic, reader.deserialize(data, c.msgtype)) for c, _, data in reader.messages()]
    drive = [message for topic, message in found if topic == DRIVE]
    assert {tuple(message.channel) for message in drive} == {("pressure_chamber_pa",)}
    assert [message.value.tolist() for message in drive] == driven.voltage[:, :1].tolist()
    assert STATE not in {topic for topic, _ in found}
