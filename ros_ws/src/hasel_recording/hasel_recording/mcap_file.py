"""The messages and metadata of an MCAP file, also of one whose writer was killed."""

import mmap
import os
import struct
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from hasel_common.names import nearest
from hasel_common.topics import TOPIC_TYPES, known_as
from mcap.exceptions import McapError
from mcap.records import Channel, Message, Metadata, Schema
from mcap_ros2.decoder import DecoderFactory

from hasel_recording.errors import RecordingError, RecordingWarning
from hasel_recording.mcap_records import MAGIC, Damage, whole_records

UNREADABLE = (McapError, ValueError, LookupError, struct.error, MemoryError, OverflowError, TypeError)
"""What decoding a message, or its definition, raises where bytes make no sense."""


@dataclass
class McapFile:
    """What one file holds, by topic; messages stay encoded until asked for."""

    path: Path
    channels: dict[int, Channel] = field(default_factory=dict)
    schemas: dict[int, Schema] = field(default_factory=dict)
    messages: dict[str, list[Message]] = field(default_factory=dict)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)

    def decoded(self, topic: str, type_name: str) -> list[Any]:
        """Return the topic's messages in recorded order, none when there are none.

        A topic of hasel_common.topics is found in whatever namespace it was recorded. Raises RecordingError when
        the messages are not of this type, or two rigs have such a topic.
        """
        topic = self.name_of(topic)
        messages = self.messages.get(topic, [])
        if not messages:
            return []
        decoders = DecoderFactory()
        channel = self.channels[messages[0].channel_id]
        schema = self.schemas.get(channel.schema_id)
        found = schema.name if schema else "no type"
        if found != type_name:
            raise RecordingError(
                f"{self.path}: topic {topic} holds {found}, but {type_name} is expected; remap the topic."
            )
        try:
            decode = decoders.decoder_for(channel.message_encoding, schema)
        except Exception:  # noqa: BLE001 - parsers of definitions raise what they like
            raise RecordingError(
                f"{self.path}: the definition of {topic} is damaged: restore the file from a copy."
            ) from None
        if decode is None:
            raise RecordingError(
                f"{self.path}: {topic} is {channel.message_encoding} with a {schema.encoding} "
                "definition, but cdr with ros2msg is expected; record it with ROS 2 Jazzy."
            )
        return self._whole(topic, messages, decode)

    def _whole(self, topic: str, messages: list[Message], decode: Callable[[bytes], Any]) -> list[Any]:
        """The messages that can be decoded; a RecordingWarning says how many cannot."""
        decoded, damaged = [], 0
        for message in messages:
            try:
                decoded.append(decode(message.data))
            except UNREADABLE:
                damaged += 1
        if damaged:
            warnings.warn(
                f"{self.path}: {damaged} damaged messages on {topic} were left out; restore the file from a copy.",
                RecordingWarning,
                stacklevel=5,
            )
        return decoded

    def name_of(self, topic: str) -> str:
        """Return what a topic is called here: its name, or the same in another namespace where there is only that."""
        if topic in self.messages or topic not in TOPIC_TYPES:
            return topic
        names = sorted(name for name in self.messages if known_as(name) == topic and self._has(name, topic))
        if len(names) > 1:
            raise RecordingError(
                f"{self.path} has {' and '.join(names)}, of {len(names)} rigs: record one rig by itself "
                "(ros2 bag record --regex '/rig1/.*'), or split the bag with `ros2 bag convert`."
            )
        return names[0] if names else topic

    def _has(self, name: str, topic: str) -> bool:
        schema = self.schemas.get(self.channels[self.messages[name][0].channel_id].schema_id)
        return schema is not None and schema.name == TOPIC_TYPES[topic]

    def missing(self, topic: str) -> RecordingError:
        """Return the error that says a topic is missing and which there are."""
        if topic in self.messages:
            return RecordingError(
                f"{self.path}: no message on {topic} can be read: restore the file from a copy."
            )
        near = nearest(topic, self.messages)
        present = ", ".join(sorted(self.messages)) or "no message at all"
        hint = f"is {near} meant? Then remap it." if near else "record it too."
        return RecordingError(f"{self.path} has no topic {topic}, only {present}: {hint}")


def read_file(path: Path) -> McapFile:
    """Read all of a file that is whole; of a damaged one what is, with a RecordingWarning of what is not."""
    content, damage = McapFile(path), Damage()
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
                    content.channels.setdefault(record.id, record)
                elif isinstance(record, Schema):
                    content.schemas.setdefault(record.id, record)
                elif isinstance(record, Metadata):
                    content.metadata.setdefault(record.name, {}).update(record.metadata)
    for number, messages in by_channel.items():
        if number in content.channels:
            content.messages.setdefault(content.channels[number].topic, []).extend(messages)
        else:
            damage.nameless += len(messages)
    if damage.unread and not (content.messages or content.metadata):
        raise RecordingError(f"{path} is not an MCAP file: give a recording in MCAP or CSV.")
    for sentence in damage.sentences():
        warnings.warn(f"{path} {sentence}", RecordingWarning, stacklevel=5)
    return content
