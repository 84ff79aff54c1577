# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import math
from dataclasses import replace

import numpy as np
import pytest
from hasel_common.topics import COMMAND, DRIVE, MEASURED, SIMULATED, STATE
from hasel_recording import (
    DriveChannel,
    McapRecorder,
    RecordingError,
    RecordingWarning,
    read_recording,
    write_recording,
)
from hasel_recording.ros_messages import bending_angle_message
from mcap.writer import Writer
from rosbags.highlevel import AnyReader

EPOCH_NS = 1_790_000_000_000_000_000


def angle(sin_theta: float, valid: bool = True) -> dict:
    """Return a BendingAngle."""
    pixels = [[400.0, 540.0], [800.0, 540.0], [1200.0, 540.0 - 400 * sin_theta]]
    names = ("head", "middle", "tail")
    return bending_angle_message(sin_theta, marker_names=names, pixels=pixels) | {"valid": valid}


def state(upper: float, lower: float) -> dict:
    """Return a SupplyState with this voltage [V]."""
    unknown = [math.nan, math.nan]
    supply = {
        "muscle": ["upper", "lower"],
        "commanded_voltage": [upper, lower],
        "measured_voltage": unknown,
        "current": unknown,
    }
    safety = {
        "grounded": False,
        "ground": 0,
        "commander": "",
        "interlock": [0, 0],
        "emergency_stop_holders": [],
    }
    limits = dict.fromkeys(("maximum_voltage", "slew_rate", "trip_current", "heartbeat_timeout"), math.nan)
    return supply | {"mode": 2, "fault_code": 0, "fault_text": ""} | safety | limits


@pytest.fixture
def recorder(tmp_path):
    """An open recorder of run.mcap."""
    with McapRecorder(tmp_path / "run.mcap") as opened:
        yield opened


def read(recorder: McapRecorder):
    """Close the recorder and read what it wrote."""
    recorder.close()
    return read_recording(recorder.path)


def test_live_run_is_sampled_at_the_frames(recorder):
    """Frames have the voltage that held at their stamp; the exact instants of switching are kept beside."""
    for milliseconds, upper in ((0, 0.0), (10, 4000.0), (20, 4000.0), (25, 0.0)):
        recorder.write(STATE, state(upper, -upper), EPOCH_NS + milliseconds * 1_000_000)
    for milliseconds in (8, 16, 24, 32):
        recorder.write(MEASURED, angle(milliseconds / 100), EPOCH_NS + milliseconds * 1_000_000)
    run = read(recorder)
    assert run.time_s.tolist() == [0.008, 0.016, 0.024, 0.032]
    assert run.sin_theta.tolist() == [0.08, 0.16, 0.24, 0.32]
    assert run.voltage.tolist() == [[0, 0], [4000, -4000], [4000, -4000], [0, 0]]
    assert run.drive_time_s.tolist() == [0.0, 0.010, 0.025]
    assert run.drive_values.tolist() == [[0, 0], [4000, -4000], [0, 0]]
    assert run.markers[1].tolist() == [[400, 540], [800, 540], [1200, 540 - 400 * 0.16]]
    assert run.marker_unit == "px"


def test_lost_frames_stay_as_nan(recorder):
    """A frame marked invalid keeps its place in time without an angle, whatever number it carries."""
    for index, valid in enumerate((True, False, True)):
        recorder.write(MEASURED, angle(0.1, valid), EPOCH_NS + index)
    run = read(recorder)
    assert np.isnan(run.sin_theta).tolist() == [False, True, False]
    assert run.voltage is None


def test_frames_before_the_first_state_are_left_out_aloud(recorder):
    """The voltage before the supply first spoke is not known, so these frames are not used."""
    recorder.write(STATE, state(0, 0), EPOCH_NS + 15)
    for offset in (0, 10, 20):
        recorder.write(MEASURED, angle(0.1), EPOCH_NS + offset)
    with pytest.warns(RecordingWarning, match="2 frames before the first /hasel/state"):
        run = read(recorder)
    assert run.time_s == pytest.approx([20e-9])


def test_simulated_angle_is_read_too(recorder):
    """What a simulator published during the run comes with its own times."""
    recorder.write(MEASURED, angle(0.1), EPOCH_NS)
    recorder.write(SIMULATED, angle(0.2), EPOCH_NS + 500_000_000)
    run = read(recorder)
    assert (run.simulated_time_s.tolist(), run.simulated_sin_theta.tolist()) == ([0.5], [0.2])


def test_no_measured_angle(recorder):
    """A file without the angle says which topics there are and which one is nearest."""
    recorder.write("/hasel/bending/measurd", angle(0.1), 1, "hasel_interfaces/msg/BendingAngle")
    recorder.write(COMMAND, {"voltage": [0.0, 0.0]}, 1)
    with pytest.raises(
        RecordingError, match=r"no topic /hasel/bending/measured, only .*is /hasel/bending/measurd meant"
    ):
        read(recorder)


def test_misspelt_state_is_not_a_passive_body(recorder):
    """A topic that looks like a misspelt state is asked about rather than ignored."""
    recorder.write(MEASURED, angle(0.1), 1)
    recorder.write("/hasel/states", state(0, 0), 1, "hasel_interfaces/msg/SupplyState")
    with pytest.raises(RecordingError, match=r"no topic /hasel/state,.*is /hasel/states meant"):
        read(recorder)


def test_wrong_type(recorder):
    """The right topic with another type is named with both types."""
    recorder.write(MEASURED, {"data": 0.1}, 1, "std_msgs/msg/Float64")
    with pytest.raises(
        RecordingError, match="holds std_msgs/msg/Float64, but hasel_interfaces/msg/BendingAngle"
    ):
        read(recorder)


def test_unknown_encoding(tmp_path):
    """A file in another encoding than ROS 2's says which is expected."""
    with (tmp_path / "json.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start()
        schema = writer.register_schema("hasel_interfaces/msg/BendingAngle", "jsonschema", b"{}")
        writer.add_message(writer.register_channel(MEASURED, "json", schema), 1, b"{}", 1)
        writer.finish()
    with pytest.raises(RecordingError, match="json with a jsonschema definition, but cdr with ros2msg"):
        read_recording(tmp_path / "json.mcap")


@pytest.mark.parametrize("voltage", [math.inf, math.nan])
def test_impossible_voltage(recorder, voltage):
    """An infinite voltage, or no number, is an error with the message's number."""
    recorder.write(STATE, state(0, 0), 1)
    recorder.write(STATE, state(0, voltage), 2)
    recorder.write(MEASURED, angle(0.1), 2)
    with pytest.raises(RecordingError, match="message 2 on /hasel/state commands"):
        read(recorder)


def test_time_that_runs_backwards(recorder):
    """Stamps that do not increase are an error."""
    for stamp_ns in (10, 30, 20):
        recorder.write(MEASURED, angle(0.1), stamp_ns)
    with pytest.raises(RecordingError, match="message 3 on /hasel/bending/measured is not later"):
        read(recorder)


def test_repeated_state_counts_once(recorder):
    """A state that is published again with the same stamp replaces the one before."""
    for upper in (0.0, 1000.0, 2000.0):
        recorder.write(STATE, state(upper, 0.0), 5)
    recorder.write(MEASURED, angle(0.1), 5)
    assert read(recorder).voltage.tolist() == [[2000.0, 0.0]]


def test_frames_before_the_supply_knew_its_voltage_are_left_out(recorder):
    """A driver that begins in a fault says NaN: what comes before its first voltage is not used, and said."""
    for milliseconds, upper in ((0, math.nan), (10, math.nan), (20, 0.0), (30, 4000.0)):
        recorder.write(STATE, state(upper, upper), EPOCH_NS + milliseconds * 1_000_000)
    for milliseconds in (5, 15, 25, 35):
        recorder.write(MEASURED, angle(0.1), EPOCH_NS + milliseconds * 1_000_000)
    with pytest.warns(RecordingWarning, match="2 frames before the first /hasel/state"):
        run = read(recorder)
    assert run.voltage[:, 0].tolist() == [0.0, 4000.0]


def test_frames_after_the_drives_end_are_left_out_aloud(recorder):
    """From where no voltage is known up to the end, frames are not read, and that is said."""
    recorder.write(STATE, state(3000, 0), 0)
    recorder.write(STATE, state(math.nan, math.nan), 20)
    for stamp in (0, 10, 20, 30):
        recorder.write(MEASURED, angle(0.1 + stamp / 100), stamp)
    with pytest.warns(RecordingWarning, match="2 frames after the drive's end were left out"):
        run = read(recorder)
    assert run.sin_theta.tolist() == [0.1, 0.2]
    assert run.voltage.tolist() == [[3000, 0], [3000, 0]]


def test_a_drive_signal_is_refused_where_it_is_not_understood(recorder):
    """Other channels in mid-run, and units that are not SI, are one sentence each."""
    recorder.write(DRIVE, {"channel": ["pressure_chamber_mbar"], "value": [1.0]}, 1)
    recorder.write(MEASURED, angle(0.1), 2)
    with pytest.raises(RecordingError, match="expected the SI unit, pressure_chamber_pa"):
        read(recorder)


def test_a_drive_signal_keeps_its_channels(recorder):
    """A message with other channels than the first is refused with its number."""
    recorder.write(DRIVE, {"channel": ["pressure_a_pa"], "value": [1.0]}, 1)
    recorder.write(DRIVE, {"channel": ["pressure_a_pa", "pressure_b_pa"], "value": [1.0, 2.0]}, 2)
    recorder.write(MEASURED, angle(0.1), 3)
    with pytest.raises(RecordingError, match="message 2 on /hasel/drive has 2 values"):
        read(recorder)


def test_a_supply_of_other_muscles_is_read_by_their_names(tmp_path):
    """The voltages of a state belong to the muscles that it names, however many there are."""
    names = ["left", "right", "tail"]
    supply = state(0.0, 0.0) | {"muscle": names, "commanded_voltage": [1000.0, 0.0, -2000.0]}
    with McapRecorder(tmp_path / "run.mcap") as recorder:
        recorder.write(STATE, supply, 0)
        recorder.write(MEASURED, bending_angle_message(0.1), 10)
    run = read_recording(tmp_path / "run.mcap")
    assert [channel.column for channel in run.channels] == [f"voltage_{name}_v" for name in names]
    assert run.drive_signal.tolist() == [[1000.0, 0.0, -2000.0]]


def test_voltages_for_other_muscles_than_before_are_refused(tmp_path):
    """One sentence says which message has which voltages."""
    with McapRecorder(tmp_path / "run.mcap") as recorder:
        recorder.write(STATE, state(0.0, 0.0), 0)
        recorder.write(STATE, state(0.0, 0.0) | {"commanded_voltage": [1.0, 2.0, 3.0]}, 5)
        recorder.write(MEASURED, bending_angle_message(0.1), 10)
    with pytest.raises(RecordingError, match="message 2 on /hasel/state has 3 values for upper, lower"):
        read_recording(tmp_path / "run.mcap")


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
