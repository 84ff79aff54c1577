"""Write messages to an MCAP file such that a killed process loses at most the last second."""

import os
import threading
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hasel_common.names import nearest
from hasel_common.provenance import installed_version
from hasel_common.topics import FRAMES, TOPIC_TYPES
from mcap.well_known import SchemaEncoding
from mcap.writer import Writer
from mcap_ros2._dynamic import (
    serialize_dynamic,
)  # the package's own writer offers neither flush nor channel metadata

from hasel_recording.errors import RecordingError
from hasel_recording.message_definitions import has_header, schema_text
from hasel_recording.message_fields import plain_fields, stamp, type_of
from hasel_recording.rosbag2_metadata import TopicCount, bag_metadata, channel_metadata

HEADER_RECORD = "hasel_recording"  # metadata record with the header lines
TIME_RECORD = "hasel_time"  # metadata record with the stamp that is time 0
CHUNK_BYTES = 16 * 1024
FLUSH_PERIOD_S = 0.4


class McapRecorder:
    """Records messages of any topic; may be used by several threads and as a context manager.

    path: the file, replaced when it exists. metadata: header lines such as `model`, kept with the file.
    time_origin_ns: the stamp that is time 0 of the run; None: the first one recorded.
    """

    def __init__(
        self, path: str | Path, metadata: Mapping[str, Any] | None = None, time_origin_ns: int | None = None
    ) -> None:
        self.path = Path(path)
        try:
            self._file = self.path.open("wb")
        except OSError as error:
            raise RecordingError(
                f"{self.path} cannot be written ({error.strerror}): choose another place."
            ) from None
        self._metadata = {key: str(value) for key, value in (metadata or {}).items()}
        self._topics: dict[str, TopicCount] = {}
        self._channels: dict[str, tuple[int, Any]] = {}
        self._first_ns: int | None = None
        self._last_ns = 0
        self._failure: OSError | None = None
        self._writer = Writer(self._file, chunk_size=CHUNK_BYTES)
        self._writer.start(profile="ros2", library=f"hasel_recording {installed_version('hasel_recording')}")
        self._writer.add_metadata(HEADER_RECORD, self._metadata)
        if time_origin_ns is not None:
            self._writer.add_metadata(TIME_RECORD, {"time_origin_ns": str(time_origin_ns)})
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
        type_name = type_name or type_of(message) or self._type_of_topic(topic)
        if isinstance(message, Mapping) and "header" not in message and has_header(type_name):
            message = {"header": {"stamp": stamp(stamp_ns), "frame_id": FRAMES.get(topic, "")}, **message}
        fields = plain_fields(message, type_name)
        with self._lock:
            if self._file.closed:
                raise RecordingError(f"{self.path} is closed: make a new recorder for a new run.")
            if self._failure is not None:
                raise RecordingError(
                    f"{self.path} cannot be written on ({self._failure.strerror}): free some space."
                )
            channel, encode = self._channel(topic, type_name)
            self._writer.add_message(channel, log_time=stamp_ns, publish_time=stamp_ns, data=encode(fields))
            self._topics[topic].count += 1
            self._first_ns = stamp_ns if self._first_ns is None else min(self._first_ns, stamp_ns)
            self._last_ns = max(self._last_ns, stamp_ns)

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
            try:
                self._finish()
            except OSError as error:
                raise RecordingError(
                    f"{self.path} could not be finished ({error.strerror}): what it holds so far can be read."
                ) from None

    def _finish(self) -> None:
        first = self._first_ns or 0
        bag = bag_metadata(self.path.name, self._topics, first, max(first, self._last_ns), self._metadata)
        with self._file:
            self._writer.flush()
            self._writer.add_metadata("rosbag2", bag)
            self._writer.finish()
            self._file.flush()
            os.fsync(self._file.fileno())

    def __enter__(self) -> "McapRecorder":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _type_of_topic(self, topic: str) -> str:
        if topic not in TOPIC_TYPES:
            hint = nearest(topic, TOPIC_TYPES, similarity=0.0)
            raise RecordingError(
                f"The type of topic {topic!r} is not known: give type_name, or did you mean {hint!r}?"
            )
        return TOPIC_TYPES[topic]

    def _channel(self, topic: str, type_name: str) -> tuple[int, Any]:
        """Return the topic's channel and the encoder of its messages, made at the first message."""
        if topic not in self._channels:
            text = schema_text(type_name)
            schema = self._writer.register_schema(type_name, SchemaEncoding.ROS2, text.encode())
            channel = self._writer.register_channel(topic, "cdr", schema, channel_metadata(type_name))
            self._channels[topic] = channel, serialize_dynamic(type_name, text)[type_name]
            self._topics[topic] = TopicCount(type_name)
        elif self._topics[topic].type_name != type_name:
            raise RecordingError(
                f"Topic {topic!r} holds {self._topics[topic].type_name}, so no {type_name} can follow: "
                "use another topic."
            )
        return self._channels[topic]

    def _flush_until_closed(self) -> None:
        while not self._closing.wait(FLUSH_PERIOD_S):
            try:
                with self._lock:
                    self._writer.flush()
                os.fsync(
                    self._file.fileno()
                )  # outside the lock: a slow disk must not hold up the writing thread
            except OSError as error:
                self._failure = error
                return
