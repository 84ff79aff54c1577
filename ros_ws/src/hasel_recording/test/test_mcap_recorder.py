# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import os
import signal
import subprocess
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import pytest
import yaml
from hasel_common.topics import COMMAND, MEASURED, STATE
from hasel_interfaces.msg import SupplyState
from hasel_recording import McapRecorder, RecordingError, RecordingWarning, mcap_recorder, read_recording
from hasel_recording.bag import read_file
from hasel_recording.mcap_recorder import HEADER_RECORD
from mcap.reader import make_reader
from rclpy.serialization import deserialize_message, serialize_message
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader


def state_at(stamp_ns: int) -> SupplyState:
    """Return a message with something in every kind of field."""
    message = SupplyState(mode=SupplyState.FAULT, fault_code=7, fault_text="over-current on the upper side")
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp_ns, 1_000_000_000)
    message.commanded_voltage = np.array([5500.25, -1200.5])
    message.measured_voltage = np.array([np.nan, -1199.0])
    return message


@pytest.mark.parametrize("rate_hz", [120, 8])
def test_killed_writer_loses_at_most_a_second(rate_hz, tmp_path):
    """A writing process that is killed outright leaves a file that lacks less than its last second."""
    path = tmp_path / "killed.mcap"
    program = Path(__file__).with_name("killed_writer.py")
    writer = subprocess.Popen(
        [sys.executable, program, path, str(rate_hz)], stdout=subprocess.PIPE, text=True
    )
    first_ns = int(writer.stdout.readline())
    last_ns = first_ns
    while last_ns < first_ns + 2_500_000_000:
        last_ns = int(writer.stdout.readline())
    writer.send_signal(signal.SIGKILL)
    unread = writer.stdout.read().split()
    writer.wait()
    last_ns = int(unread[-1]) if unread else last_ns
    with pytest.warns(RecordingWarning, match="truncated"):
        stamps = [message.log_time for message in read_file(path).messages[MEASURED]]
    assert stamps[0] == first_ns
    assert (last_ns - stamps[-1]) / 1e9 < 1.0


def kill_at_once(path: Path, writes: str) -> None:
    """Begin a recording, write, and be killed before anything is flushed by the clock."""
    program = f"""
import os, signal
from hasel_recording import McapRecorder, mcap_recorder
mcap_recorder.FLUSH_PERIOD_S = 60
recorder = McapRecorder({str(path)!r}, {{"model": "swimmer"}}, time_origin_ns=5)
{writes}
os.kill(os.getpid(), signal.SIGKILL)
"""
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == -signal.SIGKILL


def test_a_writer_killed_before_the_first_message_leaves_an_empty_recording(tmp_path):
    """Its header lines are there, and reading a run from it is refused in one sentence, without a warning."""
    kill_at_once(tmp_path / "run.mcap", "")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        content = read_file(tmp_path / "run.mcap")
        with pytest.raises(RecordingError, match="is an empty recording: it ended before the first message"):
            read_recording(tmp_path / "run.mcap")
    assert content.metadata[HEADER_RECORD] == {"model": "swimmer"}
    assert content.messages == {}


def test_the_first_message_of_every_topic_is_on_the_disk_at_once(tmp_path):
    """With the topic's definition: nothing waits for the clock but the messages after it."""
    writes = "\n".join(
        f"recorder.write({topic!r}, {{'voltage': [1.0, 2.0]}}, 7, 'hasel_interfaces/msg/Actuation')"
        for topic in ("/a", "/b")
    )
    kill_at_once(tmp_path / "run.mcap", writes)
    with pytest.warns(RecordingWarning, match="truncated"):
        content = read_file(tmp_path / "run.mcap")
    for topic in ("/a", "/b"):
        (message,) = content.decoded(topic, "hasel_interfaces/msg/Actuation")
        assert list(message.voltage) == [1.0, 2.0]


def test_a_disk_that_is_full_from_the_beginning_is_reported_at_the_first_message():
    """Whoever begins a recording may have a supply to watch: no error until something is lost."""
    recorder = McapRecorder("/dev/full")
    with pytest.raises(RecordingError, match=r"cannot be written on \(No space left on device\)"):
        recorder.write(COMMAND, {"voltage": [1.0, 2.0]}, 1)
    with pytest.raises(RecordingError, match="could not be finished"):
        recorder.close()


def test_header_lines_may_be_told_later(tmp_path):
    """What is told while recording takes the place of the header lines; once closed, nothing can be told."""
    with McapRecorder(tmp_path / "run.mcap", {"model": "swimmer"}) as recorder:
        recorder.write(STATE, state_at(1), 1)
        recorder.describe({"model": "swimmer", "limit": 6000})
    assert read_file(tmp_path / "run.mcap").metadata[HEADER_RECORD] == {"model": "swimmer", "limit": "6000"}
    with pytest.raises(RecordingError, match="closed"):
        recorder.describe({})


def test_rclpy_decodes_the_same_message(tmp_path):
    """A recorded message is as long as rclpy's own and decodes to the same fields there."""
    message = state_at(1_700_000_000_123_456_789)
    with McapRecorder(tmp_path / "run.mcap") as recorder:
        recorder.write(STATE, message, 1_700_000_000_123_456_789)
    (recorded,) = read_file(tmp_path / "run.mcap").messages[STATE]
    assert len(recorded.data) == len(serialize_message(message))
    assert str(deserialize_message(recorded.data, SupplyState)) == str(message)


def test_independent_reader_gives_the_same_message(tmp_path):
    """rosbags, which shares no code with the writer, reads back every field."""
    with McapRecorder(tmp_path / "run.mcap") as recorder:
        recorder.write(STATE, state_at(5_000_000_001), 5_000_000_001)
    with AnyReader([tmp_path / "run.mcap"]) as reader:
        ((connection, log_time, data),) = reader.messages()
        message = reader.deserialize(data, connection.msgtype)
    assert log_time == 5_000_000_001
    assert message.header.stamp.nanosec == 1
    assert message.commanded_voltage.tolist() == [5500.25, -1200.5]
    assert (message.mode, message.fault_text) == (SupplyState.FAULT, "over-current on the upper side")


def test_closed_file_has_profile_index_and_statistics(tmp_path):
    """Viewers get what they look for: profile ros2, ros2msg, cdr, an index in chunks of 32 KiB or less."""
    path = tmp_path / "run.mcap"
    with McapRecorder(path, {"model": "beam"}) as recorder:
        for index in range(2000):
            recorder.write(COMMAND, {"voltage": [float(index), 0.0]}, index)
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        summary = reader.get_summary()
        assert reader.get_header().profile == "ros2"
    (channel,), (schema,) = summary.channels.values(), summary.schemas.values()
    assert (channel.message_encoding, schema.encoding) == ("cdr", "ros2msg")
    assert summary.statistics.message_count == 2000
    assert len(summary.chunk_indexes) > 1
    assert max(chunk.uncompressed_size for chunk in summary.chunk_indexes) <= 32 * 1024


def test_flushes_to_the_disk_while_open(tmp_path, monkeypatch):
    """What was written reaches the disk (fsync) soon, without another message having to come."""
    synced = []
    monkeypatch.setattr(os, "fsync", synced.append)
    monkeypatch.setattr(mcap_recorder, "FLUSH_PERIOD_S", 0.02)
    with McapRecorder(tmp_path / "run.mcap") as recorder:
        recorder.write(COMMAND, {"voltage": [1.0, 2.0]}, 1)
        deadline = time.monotonic() + 5
        while not synced and time.monotonic() < deadline:
            time.sleep(0.01)
        assert synced
        with pytest.warns(RecordingWarning, match="truncated"):
            assert len(read_file(tmp_path / "run.mcap").messages[COMMAND]) == 1


def test_full_disk_is_reported_at_the_next_write(tmp_path, monkeypatch):
    """When the disk fails, the writer of the next message is told instead of losing data silently."""

    def fail(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(mcap_recorder, "FLUSH_PERIOD_S", 0.02)
    recorder = McapRecorder(tmp_path / "run.mcap")
    with monkeypatch.context() as broken:
        broken.setattr(os, "fsync", fail)
        recorder._flusher.join(timeout=5)
    with pytest.raises(RecordingError, match="No space left on device"):
        recorder.write(COMMAND, {"voltage": [1.0, 2.0]}, 1)
    recorder.close()


def test_failure_to_finish_is_one_sentence(tmp_path, monkeypatch):
    """When the disk fails at the end, closing says so, and what was written can still be read."""

    def fail(_: int) -> None:
        raise OSError(5, "Input/output error")

    recorder = McapRecorder(tmp_path / "run.mcap")
    recorder.write(COMMAND, {"voltage": [1.0, 2.0]}, 1)
    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(RecordingError, match="Input/output error"):
        recorder.close()
    recorder.close()
    assert len(read_file(tmp_path / "run.mcap").messages[COMMAND]) == 1


def test_unknown_topic_needs_a_type(tmp_path):
    """A mapping on a topic of unknown type is refused with the nearest topic of the stack."""
    with (
        McapRecorder(tmp_path / "run.mcap") as recorder,
        pytest.raises(RecordingError, match="did you mean '/hasel/command'"),
    ):
        recorder.write("/hasel/comand", {"voltage": [1.0, 2.0]}, 1)


def test_one_topic_holds_one_type(tmp_path):
    """A second type on the same topic is refused."""
    with McapRecorder(tmp_path / "run.mcap") as recorder:
        recorder.write(COMMAND, {"voltage": [1.0, 2.0]}, 1)
        with pytest.raises(RecordingError, match="holds hasel_interfaces/msg/Actuation"):
            recorder.write(COMMAND, state_at(2), 2)


def test_writing_after_closing_is_refused(tmp_path):
    """A closed recording takes no more messages, and closing twice is fine."""
    recorder = McapRecorder(tmp_path / "run.mcap")
    recorder.close()
    recorder.close()
    with pytest.raises(RecordingError, match="is closed"):
        recorder.write(COMMAND, {"voltage": [1.0, 2.0]}, 1)


def test_folder_that_does_not_exist(tmp_path):
    """A place that cannot be written to is one sentence."""
    with pytest.raises(RecordingError, match="cannot be written"):
        McapRecorder(tmp_path / "nowhere" / "run.mcap")


def make_bag(folder: Path) -> Path:
    """Record two messages and put `metadata.yaml` beside them, taken from the file's own record."""
    with McapRecorder(folder / "bag_0.mcap", {"model": "swimmer"}) as recorder:
        for stamp_ns in (1_000_000_000, 3_500_000_000):
            recorder.write(COMMAND, {"voltage": [3500.0, 0.0]}, stamp_ns)
    record = read_file(folder / "bag_0.mcap").metadata["rosbag2"]["serialized_metadata"]
    text = yaml.safe_dump({"rosbag2_bagfile_information": yaml.safe_load(record)})
    (folder / "metadata.yaml").write_text(text)
    return folder


def test_independent_reader_accepts_the_bag(tmp_path):
    """With our metadata as metadata.yaml, rosbags opens the folder as a rosbag2 bag with the right counts."""
    with Reader(make_bag(tmp_path)) as bag:
        assert bag.message_count == 2
        assert bag.duration >= 2_500_000_000
        assert bag.ros_distro == "jazzy"
        assert len(list(bag.messages())) == 2
        (connection,) = bag.connections
        assert connection.msgtype == "hasel_interfaces/msg/Actuation"


def test_quality_of_service_is_understood(tmp_path):
    """The channel's offered_qos_profiles parses to one reliable, volatile, keep-last profile."""
    with Reader(make_bag(tmp_path)) as bag:
        (qos,) = bag.connections[0].ext.offered_qos_profiles
    assert (qos.reliability.name, qos.durability.name, qos.history.name) == (
        "RELIABLE",
        "VOLATILE",
        "KEEP_LAST",
    )
    assert qos.deadline.sec == 9223372036
