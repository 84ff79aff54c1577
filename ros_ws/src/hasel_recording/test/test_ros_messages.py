# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Definitions and fields of messages; bending angles of any number of markers, and those of bags from before that."""

import math

import numpy as np
import pytest
from hasel_common.topics import MEASURED, TOPIC_TYPES
from hasel_interfaces.msg import Fit, NamedParameter, SupplyState
from hasel_recording import McapRecorder, RecordingError, read_recording
from hasel_recording.ros_messages import (
    SEPARATOR,
    bending_angle_message,
    nanoseconds,
    plain_fields,
    schema_text,
    stamp,
    type_hash,
    type_of,
)
from mcap.writer import Writer
from mcap_ros2._dynamic import serialize_dynamic
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore


@pytest.mark.parametrize("type_name", sorted(set(TOPIC_TYPES.values())))
def test_schema_and_hash_agree_with_an_independent_parser(type_name):
    """rosbags parses the schema of every type of the stack and computes the same type hash from it."""
    typestore = get_typestore(Stores.EMPTY)
    typestore.register(get_types_from_msg(schema_text(type_name), type_name))
    assert typestore.hash_rihs01(type_name) == type_hash(type_name)


def test_unknown_package_names_the_remedy():
    """A type whose package is not installed is one sentence that says to build."""
    with pytest.raises(RecordingError, match="no_such_package/msg/Thing was not found: build the workspace"):
        schema_text("no_such_package/msg/Thing")


def test_unknown_message_of_a_known_package():
    """A message that its package does not have is named."""
    with pytest.raises(RecordingError, match="std_msgs has no message Thing"):
        schema_text("std_msgs/msg/Thing")


def test_ros_message_becomes_plain_values():
    """Arrays of numbers and nested messages come out as lists and dicts."""
    fit = Fit(model="swimmer", effects=["drag"], parameters=[NamedParameter(name="slope", value=2.0)])
    fields = plain_fields(fit, type_of(fit))
    assert fields["parameters"][0]["value"] == 2.0
    assert fields["effects"] == ["drag"]
    assert plain_fields(SupplyState(current=[1.0, 2.0]), "hasel_interfaces/msg/SupplyState")["current"] == [
        1.0,
        2.0,
    ]


def test_stamp_before_zero_goes_there_and_back():
    """A time before zero has negative seconds and positive nanoseconds."""
    fields = stamp(-295_674_500)
    assert fields == {"sec": -1, "nanosec": 704_325_500}

    class Time:
        sec, nanosec = fields["sec"], fields["nanosec"]

    assert nanoseconds(Time) == -295_674_500


def test_misspelt_field_names_the_nearest():
    """A field that the type does not have is named, with the one that was meant."""
    with pytest.raises(RecordingError, match="no field 'sec_': did you mean sec"):
        plain_fields({"sec_": 1, "nanosec": 0}, "builtin_interfaces/msg/Time")


def test_missing_field_is_not_filled_in():
    """A mapping must give every field; nothing becomes zero unasked."""
    with pytest.raises(RecordingError, match="without nanosec"):
        plain_fields({"sec": 1}, "builtin_interfaces/msg/Time")


def test_array_of_wrong_length():
    """A pair of contacts given as three is refused."""
    message = plain_fields(SupplyState(), "hasel_interfaces/msg/SupplyState") | {"interlock": [1, 1, 1]}
    with pytest.raises(RecordingError, match="Found 3 values"):
        plain_fields(message, "hasel_interfaces/msg/SupplyState")


THREE_MARKERS_ONLY = f"""std_msgs/Header header
float64 sin_theta
float64 theta
float64[3] marker_x
float64[3] marker_y
float64[3] marker_quality
bool valid
{SEPARATOR}
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
{SEPARATOR}
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""


@pytest.mark.parametrize("count", [0, 2, 3, 15])
def test_any_number_of_markers(count, tmp_path):
    """An independent reader finds all markers in order, with names, pixels, metres and quality."""
    names = [f"marker_{number}" for number in range(count)]
    pixels, quality = np.arange(2.0 * count).reshape(count, 2), np.linspace(0.5, 1.0, count)
    message = bending_angle_message(0.1, None, 0.002, names, pixels, pixels / 1000, quality.tolist(), doubt=0)
    with McapRecorder(tmp_path / "run.mcap") as recorder:
        recorder.write(MEASURED, message, 5)
    with AnyReader([tmp_path / "run.mcap"]) as reader:
        connection, _, data = next(reader.messages())
        read = reader.deserialize(data, connection.msgtype)
    assert list(read.marker_name) == names
    assert np.column_stack([read.marker_x, read.marker_y]).tolist() == pixels.tolist()
    assert np.column_stack([read.marker_x_m, read.marker_y_m]).tolist() == (pixels / 1000).tolist()
    assert (read.marker_quality.tolist(), read.sin_theta_standard_deviation) == (quality.tolist(), 0.002)
    assert read.valid and read.theta == pytest.approx(math.asin(0.1))


def test_bag_with_three_markers_only_stays_readable(tmp_path):
    """A bag carries its definition: one recorded when a message had exactly three markers is read as before."""
    kind = "hasel_interfaces/msg/BendingAngle"
    encode = serialize_dynamic(kind, THREE_MARKERS_ONLY)[kind]
    positions = {"marker_x": [1.0, 2.0, 3.0], "marker_y": [4.0, 5.0, 6.0], "marker_quality": [1.0] * 3}
    with (tmp_path / "old.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2")
        schema = writer.register_schema(kind, "ros2msg", THREE_MARKERS_ONLY.encode())
        channel = writer.register_channel(MEASURED, "cdr", schema)
        for index, valid in enumerate((True, False)):
            header = {"stamp": stamp(10**9 * (index + 1)), "frame_id": "camera"}
            data = encode({"header": header, "sin_theta": 0.25, "theta": 0.25, "valid": valid} | positions)
            writer.add_message(channel, 10**9 * (index + 1), data, 10**9 * (index + 1))
        writer.finish()
    run = read_recording(tmp_path / "old.mcap")
    np.testing.assert_array_equal(run.sin_theta, [0.25, np.nan])
    assert run.time_s.tolist() == [0.0, 1.0]
    assert run.markers[0].tolist() == [[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]]
