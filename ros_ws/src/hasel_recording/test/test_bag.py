"""Bags as `ros2 bag record` writes them, made here by an independent library, read as the run they hold."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from hasel_recording import read_recording, write_recording
from hasel_recording.bending_angle_message import bending_angle_message
from hasel_recording.errors import RecordingError
from hasel_recording.mcap_recorder import McapRecorder
from hasel_recording.message_definitions import type_hash
from mcap.reader import make_reader
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from rosbags.rosbag2 import CompressionFormat, CompressionMode, Reader, StoragePlugin, Writer


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
