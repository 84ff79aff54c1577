"""BendingAngle messages of any number of markers, and those of bags from before that."""

import math

import numpy as np
import pytest
from hasel_common.topics import MEASURED
from hasel_recording import McapRecorder, read_recording
from hasel_recording.bending_angle_message import bending_angle_message
from hasel_recording.message_definitions import SEPARATOR
from hasel_recording.message_fields import stamp
from mcap.writer import Writer
from mcap_ros2._dynamic import serialize_dynamic
from rosbags.highlevel import AnyReader

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
