# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The messages of a bag: an MCAP file, or what `ros2 bag record` writes, a folder with metadata.yaml and files.

MCAP files are read here, also those whose writer was killed; SQLite, and what is compressed, by `rosbags`.
"""

import mmap
import os
import struct
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml
from hasel_common.names import nearest
from hasel_common.topics import TOPIC_TYPES, known_as
from mcap.exceptions import McapError
from mcap.records import Channel, Message, Metadata, Schema
from mcap.well_known import SchemaEncoding
from mcap_ros2.decoder import DecoderFactory
from rosbags.interfaces import MessageDefinitionFormat
from rosbags.rosbag2 import Reader, ReaderError

from hasel_recording.errors import RecordingError, warn
from hasel_recording.mcap_records import MAGIC, Damage, whole_records
from hasel_recording.ros_messages import schema_text

UNREADABLE = (McapError, ValueError, LookupError, struct.error, MemoryError, OverflowError, TypeError)
"""What decoding a message, or its definition, raises where bytes make no sense."""
METADATA, SQLITE, MCAP = "metadata.yaml", ".db3", ".mcap"


@dataclass
class McapFile:
    """What one file holds, by topic; messages stay encoded until asked for.

    kinds: of every topic, how messages are encoded and their definition, None where it is missing; damaged: whether
    there may have been more messages than there are.
    """

    path: Path
    kinds: dict[str, tuple[str, Schema | None]] = field(default_factory=dict)
    messages: dict[str, list[Message]] = field(default_factory=dict)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    damaged: bool = False

    def decoded(self, topic: str, type_name: str) -> list[Any]:
        """Return the topic's messages in recorded order, none when there are none.

        A topic of hasel_common.topics is found in whatever namespace it was recorded. Raises RecordingError when the
        messages are not of this type, or two rigs have such a topic; a RecordingWarning says how many are damaged.
        """
        topic = self._name_of(topic)
        if topic not in self.messages:
            return []
        encoding, schema = self.kinds[topic]
        found = schema.name if schema else "no type"
        if schema is None or found != type_name:
            raise RecordingError(
                f"{self.path}: topic {topic} holds {found}, but {type_name} is expected; remap the topic."
            )
        try:
            decode = DecoderFactory().decoder_for(encoding, schema)
        except Exception:  # noqa: BLE001 - parsers of definitions raise what they like
            raise RecordingError(
                f"{self.path}: the definition of {topic} is damaged: restore the file from a copy."
            ) from None
        if decode is None:
            raise RecordingError(
                f"{self.path}: {topic} is {encoding} with a {schema.encoding} "
                "definition, but cdr with ros2msg is expected; record it with ROS 2 Jazzy."
            )
        decoded = []
        for message in self.messages[topic]:
            with suppress(*UNREADABLE):
                decoded.append(decode(message.data))
        if damaged := len(self.messages[topic]) - len(decoded):
            warn(
                f"{self.path}: {damaged} damaged messages on {topic} were left out; restore the file from a copy."
            )
        return decoded

    def _name_of(self, topic: str) -> str:
        """Return what a topic is called here: its name, or the same in another namespace where there is only that."""
        if topic in self.messages or topic not in TOPIC_TYPES:
            return topic
        same = [(name, self.kinds[name][1]) for name in self.messages if known_as(name) == topic]
        names = sorted(name for name, kind in same if kind and kind.name == TOPIC_TYPES[topic])
        if len(names) > 1:
            raise RecordingError(
                f"{self.path} has {' and '.join(names)}, of {len(names)} rigs: record one rig by itself "
                "(ros2 bag record --regex '/rig1/.*'), or split the bag with `ros2 bag convert`."
            )
        return names[0] if names else topic

    def missing(self, topic: str) -> RecordingError:
        """Return the error that says a topic is missing and which there are."""
        if topic in self.messages or (self.damaged and not self.messages):
            return RecordingError(
                f"{self.path}: no message on {topic} can be read: restore the file from a copy."
            )
        if not self.messages:
            return RecordingError(
                f"{self.path} is an empty recording: it ended before the first message came; record the run again."
            )
        near = nearest(topic, self.messages)
        hint = f"is {near} meant? Then remap it." if near else "record it too."
        return RecordingError(
            f"{self.path} has no topic {topic}, only {', '.join(sorted(self.messages))}: {hint}"
        )


def read_file(path: Path) -> McapFile:
    """Read all of a file that is whole; of a damaged one what is, with a RecordingWarning of what is not.

    A writer that was killed before the first message leaves a recording without messages.
    """
    content, damage = McapFile(path), Damage()
    channels: dict[int, Channel] = {}
    schemas: dict[int, Schema] = {}
    by_channel: dict[int, list[Message]] = {}
    with path.open("rb") as file:
        if not os.fstat(file.fileno()).st_size:
            raise RecordingError(f"{path} is empty: was the recording stopped before it began?")
        with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
            damage.unread = 0 if data[: len(MAGIC)] == MAGIC else len(MAGIC)
            for record in whole_records(data, damage):
                if isinstance(record, Message):
                    by_channel.setdefault(record.channel_id, []).append(record)
                elif isinstance(record, Channel):
                    channels.setdefault(record.id, record)
                elif isinstance(record, Schema):
                    schemas.setdefault(record.id, record)
                elif isinstance(record, Metadata):
                    content.metadata.setdefault(record.name, {}).update(record.metadata)
    for number, messages in by_channel.items():
        channel = channels.get(number)
        if channel is None:
            damage.nameless += len(messages)
            continue
        content.messages.setdefault(channel.topic, []).extend(messages)
        content.kinds.setdefault(channel.topic, (channel.message_encoding, schemas.get(channel.schema_id)))
    if damage.unread and not (content.messages or content.metadata):
        raise RecordingError(f"{path} is not an MCAP file: give a recording in MCAP or CSV.")
    content.damaged = bool(damage.lost or damage.unread or damage.nameless or damage.rest)
    damage.cut &= bool(content.messages or content.damaged)
    for sentence in damage.sentences():
        warn(f"{path} {sentence}")
    return content


def read_bag(path: Path) -> McapFile:
    """Read an .mcap or .db3 file, or a bag's folder; raises RecordingError for what is none, or is damaged."""
    if path.is_file():
        return _read_with_rosbags(path) if path.suffix == SQLITE else read_file(path)
    files = _files(path)
    if any(file.suffix != MCAP for file in files):
        return _read_with_rosbags(path if (path / METADATA).is_file() else files[0])
    whole = McapFile(path)
    for part in map(read_file, files):
        whole.kinds = part.kinds | whole.kinds
        for topic, messages in part.messages.items():
            whole.messages.setdefault(topic, []).extend(messages)
        for name, record in part.metadata.items():
            whole.metadata.setdefault(name, {}).update(record)
        whole.damaged |= part.damaged
    return whole


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
        information = yaml.safe_load(file.read_text(encoding="utf-8"))["rosbag2_bagfile_information"]
        names = information["relative_file_paths"]
    except (yaml.YAMLError, KeyError, TypeError, UnicodeDecodeError):
        names = None
    if not isinstance(names, list) or not names or not all(isinstance(name, str) for name in names):
        raise RecordingError(
            f"{file} does not say which files the bag has: restore it, or `ros2 bag reindex`."
        )
    return names


def _read_with_rosbags(path: Path) -> McapFile:
    content = McapFile(path)
    try:
        with Reader(path) as reader:
            for number, connection in enumerate(reader.connections, start=1):
                kind, stored = connection.msgtype, connection.msgdef
                kept = stored.format == MessageDefinitionFormat.MSG and stored.data  # not before ROS 2 Iron
                schema = Schema(number, (kept or schema_text(kind)).encode(), SchemaEncoding.ROS2, kind)
                content.kinds.setdefault(connection.topic, ("cdr", schema))
            for connection, stamp_ns, data in reader.messages():
                message = Message(connection.id, stamp_ns, bytes(data), stamp_ns, 0)
                content.messages.setdefault(connection.topic, []).append(message)
    except (ReaderError, OSError, ValueError) as error:
        raise RecordingError(
            f"{path} is no bag that can be read ({error}): restore it from a copy."
        ) from None
    return content
