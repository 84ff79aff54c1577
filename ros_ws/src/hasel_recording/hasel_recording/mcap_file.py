"""The messages and metadata of an MCAP file, also of one whose writer was killed."""

import struct
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mcap.exceptions import EndOfFile, InvalidMagic, McapError
from mcap.records import Channel, McapRecord, Message, Metadata, Schema
from mcap.stream_reader import CRCValidationError, StreamReader
from mcap_ros2.decoder import DecoderFactory

from hasel_recording.errors import RecordingError, RecordingWarning, nearest
from hasel_recording.topics import TOPIC_TYPES, known_as


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

        A topic of hasel_recording.topics is found in whatever namespace it was recorded. Raises RecordingError when
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
        decode = decoders.decoder_for(channel.message_encoding, schema)
        if decode is None:
            raise RecordingError(
                f"{self.path}: {topic} is {channel.message_encoding} with a {schema.encoding} "
                "definition, but cdr with ros2msg is expected; record it with ROS 2 Jazzy."
            )
        return [decode(message.data) for message in messages]

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
        near = nearest(topic, self.messages)
        present = ", ".join(sorted(self.messages)) or "no message at all"
        hint = f"is {near} meant? Then remap it." if near else "record it too."
        return RecordingError(f"{self.path} has no topic {topic}, only {present}: {hint}")


def read_file(path: Path) -> McapFile:
    """Read a whole file; a truncated one is read to its last whole message, with a RecordingWarning."""
    content = McapFile(path)
    with path.open("rb") as file:
        for record in _whole_records(StreamReader(file, validate_crcs=True), path):
            if isinstance(record, Message):
                topic = content.channels[record.channel_id].topic
                content.messages.setdefault(topic, []).append(record)
            elif isinstance(record, Channel):
                content.channels[record.id] = record
            elif isinstance(record, Schema):
                content.schemas[record.id] = record
            elif isinstance(record, Metadata):
                content.metadata.setdefault(record.name, {}).update(record.metadata)
    return content


def _whole_records(reader: StreamReader, path: Path) -> Iterator[McapRecord]:
    started = False
    try:
        for record in reader.records:
            started = True
            yield record
    except (EndOfFile, struct.error):
        if not started:
            raise RecordingError(f"{path} is empty: was the recording stopped before it began?") from None
        warnings.warn(
            f"{path} is truncated (its writer was killed?); it was read to the last whole message.",
            RecordingWarning,
            stacklevel=5,
        )
    except InvalidMagic:
        raise RecordingError(f"{path} is not an MCAP file: give a recording in MCAP or CSV.") from None
    except (McapError, CRCValidationError) as error:
        raise RecordingError(f"{path} is damaged ({error}): restore it from a copy.") from None
