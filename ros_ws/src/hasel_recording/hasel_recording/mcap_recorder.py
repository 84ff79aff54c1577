# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Write messages to an MCAP file such that a killed process loses at most the last second."""

import os
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml
from hasel_common.names import nearest
from hasel_common.provenance import installed_version
from hasel_common.topics import FRAMES, TOPIC_TYPES
from mcap.well_known import SchemaEncoding
from mcap.writer import Writer
from mcap_ros2._dynamic import serialize_dynamic  # the package's own writer has no flush, no channel metadata

from hasel_recording.errors import RecordingError
from hasel_recording.ros_messages import has_header, plain_fields, schema_text, stamp, type_hash, type_of

HEADER_RECORD = "hasel_recording"  # metadata record with the header lines
TIME_RECORD = "hasel_time"  # metadata record with the stamp that is time 0
CHUNK_BYTES = 16 * 1024
FLUSH_PERIOD_S = 0.4
_LATEST_NS = 2**63 - 1
_INFINITE = {"sec": 9223372036, "nsec": 854775807}
_RELIABLE_QOS = {
    "history": "keep_last",
    "depth": 10,
    "reliability": "reliable",
    "durability": "volatile",
    "deadline": _INFINITE,
    "lifespan": _INFINITE,
    "liveliness": "automatic",
    "liveliness_lease_duration": _INFINITE,
    "avoid_ros_namespace_conventions": False,
}


@dataclass
class _Topic:
    """What a topic holds, how it is written, and how often it was."""

    type_name: str
    channel: int
    encode: Callable[[Any], bytes]
    count: int = 0


class _PlainDumper(yaml.SafeDumper):
    """Writes repeated values out instead of referring to the first one."""

    def ignore_aliases(self, data: object) -> bool:
        return True


def _yaml_text(data: object) -> str:
    return yaml.dump(data, Dumper=_PlainDumper, sort_keys=False)


def _bag_metadata(
    file_name: str, topics: dict[str, _Topic], first_ns: int, last_ns: int, custom: dict[str, str]
) -> dict[str, str]:
    """Return the content of the record `rosbag2`: what `metadata.yaml` says of a bag of this one file."""
    start = {"nanoseconds_since_epoch": first_ns}
    duration = {"nanoseconds": last_ns - first_ns}
    count = {"message_count": sum(topic.count for topic in topics.values())}
    told = [
        {
            "topic_metadata": {
                "name": name,
                "type": topic.type_name,
                "serialization_format": "cdr",
                "offered_qos_profiles": [_RELIABLE_QOS],
                "type_description_hash": type_hash(topic.type_name),
            },
            "message_count": topic.count,
        }
        for name, topic in topics.items()
    ]
    bag = {
        "version": 9,
        "storage_identifier": "mcap",
        "duration": duration,
        "starting_time": start,
        **count,
        "topics_with_message_count": told,
        "compression_format": "",
        "compression_mode": "",
        "relative_file_paths": [file_name],
        "files": [{"path": file_name, "starting_time": start, "duration": duration, **count}],
        "custom_data": custom or None,
        "ros_distro": "jazzy",
    }
    return {"serialized_metadata": _yaml_text(bag)}


class McapRecorder:
    """Records messages of any topic; may be used by several threads and as a context manager.

    path: the file, replaced when it exists. metadata: header lines such as `model`, kept with the file.
    time_origin_ns: the stamp that is time 0 of the run; None: the first one recorded.
    """

    def __init__(
        self, path: str | Path, metadata: Mapping[str, Any] | None = None, time_origin_ns: int | None = None
    ) -> None:
        self.path = Path(path)
        self._metadata = {key: str(value) for key, value in (metadata or {}).items()}
        self._topics: dict[str, _Topic] = {}
        self._span_ns = _LATEST_NS, 0
        self._failure: OSError | None = None
        try:
            self._file = self.path.open("wb")
        except OSError as error:
            raise RecordingError(
                f"{self.path} cannot be written ({error.strerror}): choose another place."
            ) from None
        self._writer = Writer(self._file, chunk_size=CHUNK_BYTES)
        self._writer.start("ros2", library=f"hasel_recording {installed_version('hasel_recording')}")
        self._writer.add_metadata(HEADER_RECORD, self._metadata)
        if time_origin_ns is not None:
            self._writer.add_metadata(TIME_RECORD, {"time_origin_ns": str(time_origin_ns)})
        try:
            self._writer.flush()  # killed from here on, it is an empty recording
        except OSError as error:
            self._failure = error
        self._lock = threading.Lock()
        self._closing = threading.Event()
        self._flusher = threading.Thread(target=self._flush_until_closed, name="recording flush", daemon=True)
        self._flusher.start()

    def write(self, topic: str, message: Any, stamp_ns: int, type_name: str | None = None) -> None:
        """Append one message.

        message: a ROS message object, or a mapping that gives every field; a header left out is made from
        stamp_ns. stamp_ns: time of the message [ns], not negative. type_name: needed only for a mapping on a
        topic that is not one of the stack's.
        """
        type_name = type_name or type_of(message) or TOPIC_TYPES.get(topic)
        if type_name is None:
            hint = nearest(topic, TOPIC_TYPES, similarity=0.0)
            raise RecordingError(
                f"The type of topic {topic!r} is not known: give type_name, or did you mean {hint!r}?"
            )
        if isinstance(message, Mapping) and "header" not in message and has_header(type_name):
            message = {"header": {"stamp": stamp(stamp_ns), "frame_id": FRAMES.get(topic, "")}, **message}
        fields = plain_fields(message, type_name)
        with self._lock:
            if self._file.closed:
                raise RecordingError(f"{self.path} is closed: make a new recorder for a new run.")
            try:
                if self._failure is not None:
                    raise self._failure
                kept = self._topic(topic, type_name)
                self._writer.add_message(kept.channel, stamp_ns, kept.encode(fields), stamp_ns)
                kept.count += 1
                if kept.count == 1:
                    self._writer.flush()  # what a topic is, and its first message, do not wait for the period
            except OSError as error:
                self._failure = error
                raise RecordingError(
                    f"{self.path} cannot be written on ({error.strerror}): free some space."
                ) from None
            self._span_ns = min(self._span_ns[0], stamp_ns), max(self._span_ns[1], stamp_ns)

    def describe(self, metadata: Mapping[str, Any]) -> None:
        """Replace the header lines: what was not known yet when the recording began."""
        lines = {key: str(value) for key, value in metadata.items()}
        with self._lock:
            if self._file.closed:
                raise RecordingError(f"{self.path} is closed: make a new recorder for a new run.")
            self._metadata = lines
            self._writer.add_metadata(HEADER_RECORD, lines)  # of two records, readers keep the later

    def close(self) -> None:
        """Finish the file: write the index and what rosbag2 wants to know. A second call does nothing."""
        self._closing.set()
        self._flusher.join()
        with self._lock:
            if self._file.closed:
                return
            first_ns, last_ns = self._span_ns if any(each.count for each in self._topics.values()) else (0, 0)
            bag = _bag_metadata(self.path.name, self._topics, first_ns, last_ns, self._metadata)
            try:
                with self._file:
                    self._writer.flush()
                    self._writer.add_metadata("rosbag2", bag)
                    self._writer.finish()
                    self._file.flush()
                    os.fsync(self._file.fileno())
            except OSError as error:
                raise RecordingError(
                    f"{self.path} could not be finished ({error.strerror}): what it holds so far can be read."
                ) from None

    def __enter__(self) -> "McapRecorder":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _topic(self, topic: str, type_name: str) -> _Topic:
        """The topic's channel and encoder, made at the first message."""
        known = self._topics.get(topic)
        if known is None:
            text = schema_text(type_name)
            schema = self._writer.register_schema(type_name, SchemaEncoding.ROS2, text.encode())
            offered = {
                "offered_qos_profiles": _yaml_text([_RELIABLE_QOS]),
                "topic_type_hash": type_hash(type_name),
            }
            channel = self._writer.register_channel(topic, "cdr", schema, offered)
            known = _Topic(type_name, channel, serialize_dynamic(type_name, text)[type_name])
            self._topics[topic] = known
        elif known.type_name != type_name:
            raise RecordingError(
                f"Topic {topic!r} holds {known.type_name}, so no {type_name} can follow: use another topic."
            )
        return known

    def _flush_until_closed(self) -> None:
        while not self._closing.wait(FLUSH_PERIOD_S):
            try:
                with self._lock:
                    self._writer.flush()
                os.fsync(self._file.fileno())  # outside the lock: a slow disk must not hold up who writes
            except OSError as error:
                self._failure = error
                return
