# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""MCAP files, whole and damaged, and bags as `ros2 bag record` writes them, made here by an independent library."""

import warnings
from pathlib import Path

import numpy as np
import pytest
import yaml
from hasel_common.topics import MEASURED, STATE
from hasel_recording import RecordingError, RecordingWarning, read_recording, write_recording
from hasel_recording.bag import read_file
from hasel_recording.mcap_recorder import McapRecorder
from hasel_recording.ros_messages import bending_angle_message, type_hash
from mcap.reader import make_reader
from mcap.records import Chunk
from mcap.stream_reader import StreamReader
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from rosbags.rosbag2 import CompressionFormat, CompressionMode, Reader, StoragePlugin, Writer


def count(path) -> int:
    """Return the number of messages in all topics."""
    return sum(len(messages) for messages in read_file(path).messages.values())


@pytest.fixture
def mcap_file(driven, tmp_path):
    """The driven run as MCAP: 240 states and 240 angles in several chunks."""
    write_recording(driven, tmp_path / "run.mcap")
    return tmp_path / "run.mcap"


@pytest.mark.filterwarnings("ignore::hasel_recording.RecordingWarning")
def test_cut_anywhere_gives_every_whole_chunk(mcap_file):
    """Wherever a file is cut, all chunks before the cut are read, and nothing else happens."""
    whole = mcap_file.read_bytes()
    with mcap_file.open("rb") as file:
        chunks = [
            record
            for record in StreamReader(file, emit_chunks=True).records
            if hasattr(record, "uncompressed_size")
        ]
    assert len({chunk.message_end_time for chunk in chunks}) > 2
    counts = []
    for size in range(200, len(whole), 97):
        mcap_file.write_bytes(whole[:size])
        counts.append(count(mcap_file))
    assert counts == sorted(counts)
    assert counts[0] == 0
    assert counts[-1] == 480


def test_truncated_file_is_read_with_a_warning(mcap_file):
    """Half a file is half a recording, and the reader says that it was cut."""
    whole = mcap_file.read_bytes()
    mcap_file.write_bytes(whole[: len(whole) // 2])
    with pytest.warns(RecordingWarning, match="truncated"):
        recording = read_recording(mcap_file)
    assert 0 < len(recording.time_s) < 240


def test_damaged_chunk_is_left_out_aloud(mcap_file):
    """A flipped bit inside a chunk is not taken for data; the chunks before and after it are."""
    content = bytearray(mcap_file.read_bytes())
    with mcap_file.open("rb") as file:
        chunks = [r for r in StreamReader(file, emit_chunks=True).records if isinstance(r, Chunk)]
    position = bytes(content).index(chunks[1].data) + len(chunks[1].data) // 2
    content[position] ^= 0xFF
    mcap_file.write_bytes(content)
    with pytest.warns(RecordingWarning, match="is damaged: 1 chunks .* were left out, the rest was read"):
        assert 0 < count(mcap_file) < 480


def test_a_file_whose_messages_are_all_lost_is_not_called_empty(mcap_file):
    """Cut off within its first chunk, it had messages."""
    whole = mcap_file.read_bytes()
    with mcap_file.open("rb") as file:
        chunk = next(r for r in StreamReader(file, emit_chunks=True).records if isinstance(r, Chunk))
    mcap_file.write_bytes(whole[: whole.index(chunk.data) + 20])
    with (
        pytest.warns(RecordingWarning, match="truncated"),
        pytest.raises(RecordingError, match="no message on /hasel/bending/measured can be read: restore"),
    ):
        read_recording(mcap_file)


@pytest.mark.parametrize(
    ("content", "message"), [(b"", "is empty"), (b"time_s,sin_theta\n0,1\n", "not an MCAP file")]
)
def test_file_that_is_no_mcap(content, message, tmp_path):
    """An empty file and one of another kind are told apart."""
    (tmp_path / "run.mcap").write_bytes(content)
    with pytest.raises(RecordingError, match=message):
        read_recording(tmp_path / "run.mcap")


@pytest.mark.parametrize("options", [{"use_chunking": False}, {"compression": CompressionType.LZ4}])
def test_reads_the_other_ways_of_writing(options, mcap_file, tmp_path):
    """Files without chunks (rosbag2's fastwrite) and with lz4 hold the same run."""
    source = read_file(mcap_file)
    with (tmp_path / "other.mcap").open("wb") as file:
        writer = McapWriter(file, **options)
        writer.start(profile="ros2")
        for topic in (STATE, MEASURED):
            encoding, schema = source.kinds[topic]
            schema_id = writer.register_schema(schema.name, schema.encoding, schema.data)
            channel_id = writer.register_channel(topic, encoding, schema_id)
            for message in source.messages[topic]:
                writer.add_message(channel_id, message.log_time, message.data, message.publish_time)
        writer.finish()
    other, original = read_recording(tmp_path / "other.mcap"), read_recording(mcap_file)
    assert other.sin_theta.tolist() == original.sin_theta.tolist()
    assert other.voltage.tolist() == original.voltage.tolist()


DAMAGES = {
    "zeros at the end": lambda b, at: b[:at] + bytes(len(b) - at),
    "a hole of zeros": lambda b, at: b[:at] + bytes(300) + b[at + 300 :],
    "bytes missing": lambda b, at: b[:at] + b[at + 77 :],
    "bytes too many": lambda b, at: b[:at] + b"\x05\xff\x01" * 40 + b[at:],
    "a flipped bit": lambda b, at: b[:at] + bytes([b[at] ^ 4]) + b[at + 1 :],
    "the beginning": lambda b, at: bytes(12) + b[12:],
}


@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize("share", [0.1, 0.35, 0.6, 0.8])
def test_all_that_is_whole_is_read(damage, share, mcap_file):
    """Before and behind any damage every message is as it was, no chunk but the hit ones is lost, and it is said."""
    whole = mcap_file.read_bytes()
    known = {(m.channel_id, m.log_time): m.data for ms in read_file(mcap_file).messages.values() for m in ms}
    with mcap_file.open("rb") as file:
        chunks = [r for r in StreamReader(file, emit_chunks=True).records if isinstance(r, Chunk)]
    data_end = whole.index(chunks[-1].data) + len(chunks[-1].data)
    mcap_file.write_bytes(DAMAGES[damage](whole, int(share * data_end)))
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        content = read_file(mcap_file)
    messages = [m for ms in content.messages.values() for m in ms]
    assert said or len(messages) == len(known)  # an index that was hit is not needed
    assert all(known[m.channel_id, m.log_time] == m.data for m in messages)
    if damage != "zeros at the end":
        most = max(chunk.uncompressed_size for chunk in chunks) / sum(c.uncompressed_size for c in chunks)
        assert len(messages) >= (1 - 2.5 * most) * len(known)


def test_a_chunk_that_says_to_be_huge_takes_no_memory(mcap_file):
    """A size that was damaged is not believed."""
    with mcap_file.open("rb") as file:
        chunk = next(r for r in StreamReader(file, emit_chunks=True).records if isinstance(r, Chunk))
    content = bytearray(mcap_file.read_bytes())
    place = bytes(content).index(chunk.uncompressed_size.to_bytes(8, "little"))
    content[place : place + 8] = (1 << 44).to_bytes(8, "little")
    mcap_file.write_bytes(content)
    with pytest.warns(RecordingWarning, match="1 chunks"):
        assert count(mcap_file) > 0


def test_a_damaged_name_of_a_type_does_not_break_the_sentence(tmp_path):
    """What a file calls a type is quoted on one line, what cannot be printed as in a Python string."""
    path = tmp_path / "run.mcap"
    with path.open("wb") as file:
        writer = McapWriter(file)
        writer.start(profile="ros2")
        schema = writer.register_schema("\nasel/msg/Angle\x1b", "ros2msg", b"float64 sin_theta")
        writer.add_message(writer.register_channel(MEASURED, "cdr", schema), 0, bytes(12), 0)
        writer.finish()
    with pytest.raises(RecordingError, match=r"holds \\nasel/msg/Angle\\x1b, but") as caught:
        read_recording(path)
    assert str(caught.value).isprintable()


def test_a_chunk_of_another_size_than_it_says_is_left_out(tmp_path):
    """Without a checksum nothing but its size tells that a chunk ends in the middle of a message."""
    path = tmp_path / "run.mcap"
    with path.open("wb") as file:
        writer = McapWriter(file, compression=CompressionType.NONE, enable_crcs=False)
        writer.start(profile="ros2")
        schema = writer.register_schema("a/msg/B", "ros2msg", b"uint8[8] data")
        writer.add_message(writer.register_channel("/b", "cdr", schema), 0, b"\0\1\0\0" + bytes(range(8)), 0)
        writer.finish()
    content = bytearray(path.read_bytes())
    with path.open("rb") as file:
        (chunk,) = (r for r in StreamReader(file, emit_chunks=True).records if isinstance(r, Chunk))
    at = content.index(chunk.data) + len(chunk.data)
    head = content.rindex(bytes([6]) + (len(chunk.data) + 40).to_bytes(8, "little"), 0, at)
    short = chunk.data[:-4]
    content[head + 1 : head + 9] = (len(short) + 40).to_bytes(8, "little")
    content[at - len(chunk.data) - 8 : at] = len(short).to_bytes(8, "little") + short
    path.write_bytes(bytes(content))
    with pytest.warns(RecordingWarning, match="1 chunks"):
        assert read_file(path).messages == {}


def assert_same(read, run):
    """Times, angles and voltages are those of the run."""
    np.testing.assert_allclose(read.time_s - read.time_s[0], run.time_s - run.time_s[0], atol=2e-9)
    np.testing.assert_array_equal(read.sin_theta, run.sin_theta)
    np.testing.assert_array_equal(read.drive_signal, run.drive_signal)


@pytest.fixture
def written(driven, tmp_path) -> Path:
    """The run as one MCAP file."""
    path = tmp_path / "run.mcap"
    write_recording(driven, path)
    return path


def rebag(source: Path, folder: Path, plugin: StoragePlugin, mode: CompressionMode | None, prefix="/hasel"):
    """Copy a file into a bag's folder, perhaps compressed and into another namespace."""
    writer = Writer(folder, version=9, storage_plugin=plugin)
    if mode is not None:
        writer.set_compression(mode, CompressionFormat.ZSTD)
    with Reader(source) as reader, writer:
        copies = {
            each.id: writer.add_connection(
                each.topic.replace("/hasel", prefix, 1),
                each.msgtype,
                msgdef=each.msgdef.data,
                rihs01=type_hash(each.msgtype),
            )
            for each in reader.connections
        }
        for connection, stamp, data in reader.messages():
            writer.write(copies[connection.id], stamp, data)
    return folder


@pytest.mark.parametrize(
    ("plugin", "mode"),
    [
        (StoragePlugin.MCAP, None),
        (StoragePlugin.MCAP, CompressionMode.STORAGE),
        (StoragePlugin.SQLITE3, None),
        (StoragePlugin.SQLITE3, CompressionMode.FILE),
        (StoragePlugin.SQLITE3, CompressionMode.MESSAGE),
    ],
)
def test_folder_with_metadata(driven, written, tmp_path, plugin, mode):
    """MCAP with zstd chunks, SQLite, compressed as a file or by message; the name is the folder's."""
    read = read_recording(rebag(written, tmp_path / "bag", plugin, mode))
    assert_same(read, driven)
    assert read.name == "bag"


def test_sqlite_file_alone(driven, written, tmp_path):
    """A .db3 without its metadata.yaml."""
    folder = rebag(written, tmp_path / "bag", StoragePlugin.SQLITE3, None)
    (file,) = folder.glob("*.db3")
    assert_same(read_recording(file), driven)
    (folder / "metadata.yaml").unlink()
    assert_same(read_recording(folder), driven)


def test_split_files_in_their_order(driven, written, tmp_path):
    """`--max-bag-duration` makes several files; metadata.yaml says which."""
    folder = tmp_path / "bag"
    folder.mkdir()
    with written.open("rb") as file:
        messages = list(make_reader(file).iter_messages())
    parts = [messages[:150], messages[150:]]
    names = [f"bag_{number}.mcap" for number in range(2)]
    for name, part in zip(names, parts, strict=True):
        with (folder / name).open("wb") as file:
            writer = McapWriter(file, compression=CompressionType.ZSTD)
            writer.start(profile="ros2", library="test")
            known = {}
            for schema, channel, message in part:
                if channel.id not in known:
                    number = writer.register_schema(schema.name, schema.encoding, schema.data)
                    known[channel.id] = writer.register_channel(channel.topic, "cdr", number)
                writer.add_message(known[channel.id], message.log_time, message.data, message.publish_time)
            writer.finish()
    (folder / "metadata.yaml").write_text(
        yaml.safe_dump({"rosbag2_bagfile_information": {"version": 9, "relative_file_paths": names}})
    )
    assert_same(read_recording(folder), driven)
    (folder / names[0]).unlink()
    with pytest.raises(RecordingError, match=r"lacks bag_0\.mcap, which its metadata\.yaml lists"):
        read_recording(folder)


def test_rig_of_another_namespace(driven, written, tmp_path):
    """The topics are found in whatever namespace they were recorded."""
    folder = rebag(written, tmp_path / "bag", StoragePlugin.MCAP, None, prefix="/rig2")
    assert_same(read_recording(folder), driven)


def test_two_rigs_in_one_bag_are_not_mixed(tmp_path):
    """Which of them is meant cannot be guessed."""
    path = tmp_path / "run.mcap"
    with McapRecorder(path) as recorder:
        for stamp, rig in enumerate(("rig1", "rig2"), start=1):
            kind = "hasel_interfaces/msg/BendingAngle"
            recorder.write(f"/{rig}/bending/measured", bending_angle_message(0.1), stamp, kind)
    with pytest.raises(RecordingError, match="/rig1/bending/measured and /rig2/bending/measured, of 2 rigs"):
        read_recording(path)


@pytest.mark.parametrize("text", ["", "version: 9", "rosbag2_bagfile_information: {relative_file_paths: 3}"])
def test_metadata_that_says_nothing(tmp_path, text):
    """One sentence."""
    (tmp_path / "metadata.yaml").write_text(text)
    with pytest.raises(RecordingError, match="does not say which files the bag has"):
        read_recording(tmp_path)


def test_damaged_database(tmp_path):
    """One sentence."""
    (tmp_path / "run.db3").write_bytes(b"SQLite format 3\0" + bytes(100))
    with pytest.raises(RecordingError, match="is no bag that can be read"):
        read_recording(tmp_path / "run.db3")
