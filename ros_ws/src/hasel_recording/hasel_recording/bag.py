"""What `ros2 bag record` writes: a folder with metadata.yaml and files, MCAP or SQLite, compressed or not.

MCAP files are read by our own reader, which also reads those whose writer was killed; the others by `rosbags`.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import yaml
from mcap.records import Channel, Message, Schema
from mcap.well_known import SchemaEncoding
from rosbags.interfaces import MessageDefinitionFormat
from rosbags.rosbag2 import Reader, ReaderError

from hasel_recording.errors import RecordingError
from hasel_recording.mcap_file import McapFile, read_file
from hasel_recording.message_definitions import schema_text

METADATA = "metadata.yaml"
SQLITE = ".db3"
MCAP = ".mcap"


def read_bag(path: Path) -> McapFile:
    """Read an .mcap or .db3 file, or a bag's folder; raises RecordingError for what is none, or is damaged."""
    if path.is_file():
        return _read_with_rosbags(path) if path.suffix == SQLITE else read_file(path)
    files = _files(path)
    if all(file.suffix == MCAP for file in files):
        return _joined(path, [read_file(file) for file in files])
    return _read_with_rosbags(path if (path / METADATA).is_file() else files[0])


def _files(folder: Path) -> list[Path]:
    """The bag's files in their order."""
    if (folder / METADATA).is_file():
        names = _listed(folder / METADATA)
        missing = [name for name in names if not (folder / name).is_file()]
        if missing:
            raise RecordingError(
                f"Bag {folder} lacks {', '.join(missing)}, which its {METADATA} lists: copy the whole folder."
            )
        return [folder / name for name in names]
    files = sorted(path for path in folder.iterdir() if path.suffix in (MCAP, SQLITE))
    if len(files) != 1:
        raise RecordingError(
            f"Folder {folder} holds {len(files)} MCAP or SQLite files and no {METADATA}: name the file to read, "
            f"or make one with `ros2 bag reindex {folder}`."
        )
    return files


def _listed(file: Path) -> list[str]:
    try:
        names = yaml.safe_load(file.read_text(encoding="utf-8"))["rosbag2_bagfile_information"][
            "relative_file_paths"
        ]
    except (yaml.YAMLError, KeyError, TypeError, UnicodeDecodeError):
        names = None
    if not isinstance(names, list) or not names or not all(isinstance(name, str) for name in names):
        raise RecordingError(
            f"{file} does not say which files the bag has: restore it, or `ros2 bag reindex`."
        )
    return names


def _joined(path: Path, parts: Sequence[McapFile]) -> McapFile:
    """One content of several files, whose numbers of channels and schemas are each file's own."""
    whole = McapFile(path)
    for part in parts:
        shift = 1 + max(whole.channels, default=0)
        schemas = 1 + max(whole.schemas, default=0)
        for number, schema in part.schemas.items():
            whole.schemas[number + schemas] = replace(schema, id=number + schemas)
        for number, channel in part.channels.items():
            moved = channel.schema_id + schemas if channel.schema_id else 0
            whole.channels[number + shift] = replace(channel, id=number + shift, schema_id=moved)
        for topic, messages in part.messages.items():
            whole.messages.setdefault(topic, []).extend(
                replace(message, channel_id=message.channel_id + shift) for message in messages
            )
        for name, record in part.metadata.items():
            whole.metadata.setdefault(name, {}).update(record)
    return whole


def _read_with_rosbags(path: Path) -> McapFile:
    content = McapFile(path)
    try:
        with Reader(path) as reader:
            for number, connection in enumerate(reader.connections, start=1):
                text = _definition(connection.msgtype, connection.msgdef)
                content.schemas[number] = Schema(
                    id=number, data=text.encode(), encoding=SchemaEncoding.ROS2, name=connection.msgtype
                )
                content.channels[number] = Channel(
                    id=number, topic=connection.topic, message_encoding="cdr", metadata={}, schema_id=number
                )
            numbers = {connection.id: n for n, connection in enumerate(reader.connections, start=1)}
            for connection, stamp_ns, data in reader.messages():
                message = Message(
                    channel_id=numbers[connection.id],
                    log_time=stamp_ns,
                    data=bytes(data),
                    publish_time=stamp_ns,
                    sequence=0,
                )
                content.messages.setdefault(connection.topic, []).append(message)
    except (ReaderError, OSError, ValueError) as error:
        raise RecordingError(
            f"{path} is no bag that can be read ({error}): restore it from a copy."
        ) from None
    return content


def _definition(type_name: str, stored) -> str:
    """The definition kept in the bag; bags from before ROS 2 Iron have none, then that of the installed package."""
    if stored.format == MessageDefinitionFormat.MSG and stored.data:
        return stored.data
    return schema_text(type_name)
