"""What drove a body, from the messages of an MCAP file."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import compress
from typing import Any

import numpy as np
from hasel_common.topics import DRIVE, STATE, TOPIC_TYPES

from hasel_recording.drive_channel import HASEL_PAIR, DriveChannel, parse_column
from hasel_recording.errors import RecordingError
from hasel_recording.mcap_file import McapFile
from hasel_recording.message_fields import nanoseconds
from hasel_recording.zero_order_hold import row_in_force


@dataclass(frozen=True)
class StampedDrive:
    """The drive on a topic: values [k, channels] in SI units, each from its stamp [ns] [k] to the next.

    ended_ns: from when on it is not known any more (all channels NaN up to the last message), or None.
    """

    topic: str
    channels: tuple[DriveChannel, ...]
    stamps: np.ndarray
    values: np.ndarray
    ended_ns: int | None = None

    def at(self, stamps: np.ndarray) -> np.ndarray:
        """Values [n, channels] at stamps [ns] [n], none of them before the first."""
        return self.values[row_in_force(self.stamps, stamps)]

    def changes(self) -> np.ndarray:
        """Which messages begin a new value, the first among them, [changes]."""
        return np.concatenate([[0], 1 + np.flatnonzero(np.any(np.diff(self.values, axis=0) != 0, axis=1))])


def stamped_messages(file: McapFile, topic: str) -> tuple[list[Any], np.ndarray]:
    """Return a topic's messages and their stamps [ns]; raises RecordingError where these do not increase.

    A drive may repeat itself with the same stamp; the last one counts.
    """
    messages = file.decoded(topic, TOPIC_TYPES[topic])
    stamps = np.array([nanoseconds(message.header.stamp) for message in messages], dtype=np.int64)
    if topic in (STATE, DRIVE):
        last = np.append(np.diff(stamps) != 0, True)[: len(stamps)]
        messages, stamps = list(compress(messages, last)), stamps[last]
    late = np.flatnonzero(np.diff(stamps) <= 0)
    if late.size:
        raise RecordingError(
            f"{file.path}: message {late[0] + 2} on {topic} is not later than the one before; "
            "was the topic published by two nodes, or the clock set during the run? Record one node, by one clock."
        )
    return messages, stamps


def stamped_drive(file: McapFile) -> StampedDrive | None:
    """Return the drive of a file, None where there is none; raises RecordingError for one that is not understood.

    States at the beginning whose voltage the supply did not know yet (NaN) are left out; values of which none is known
    up to the last message are where the drive ended.
    """
    messages, stamps = stamped_messages(file, DRIVE)
    if messages:
        channels = _channels(file, messages)
        return _checked(file, DRIVE, channels, stamps, [list(message.value) for message in messages])
    messages, stamps = stamped_messages(file, STATE)
    if not messages:
        return None
    names = _names(file, STATE, [(muscles(message), message.commanded_voltage) for message in messages])
    channels = tuple(DriveChannel(name, "voltage", "V") for name in names)
    voltage = np.array([message.commanded_voltage for message in messages], dtype=float)
    known = np.isfinite(voltage).all(axis=1)
    first = int(np.argmax(known)) if known.any() else 0
    return _checked(file, STATE, channels, stamps[first:], voltage[first:], skipped=first)


def muscles(state: Any) -> list[str]:
    """Return the names of a SupplyState's muscles; one without names, as of old, has the rig's two."""
    return list(getattr(state, "muscle", ())) or [channel.name for channel in HASEL_PAIR]


def _names(file: McapFile, topic: str, named: list[tuple[list[str], Sequence[float]]]) -> list[str]:
    """Return the names that go with the values of every message; raises RecordingError where they change."""
    expected = named[0][0]
    for number, (names, values) in enumerate(named, start=1):
        if names != expected or len(values) != len(expected):
            raise RecordingError(
                f"{file.path}: message {number} on {topic} has {len(values)} values for {', '.join(names)}, "
                f"but {', '.join(expected)} are expected: publish the same channels always."
            )
    return expected


def _channels(file: McapFile, messages: list[Any]) -> tuple[DriveChannel, ...]:
    channels = []
    for name in _names(file, DRIVE, [(list(message.channel), message.value) for message in messages]):
        try:
            channel, factor = parse_column(name)
        except RecordingError as error:
            raise RecordingError(f"{file.path}: {DRIVE}: {error}") from None
        if factor != 1.0:
            raise RecordingError(
                f"{file.path}: {DRIVE} has {name}, expected the SI unit, {channel.column}: convert it."
            )
        channels.append(channel)
    return tuple(channels)


def _checked(
    file: McapFile,
    topic: str,
    channels: tuple[DriveChannel, ...],
    stamps: np.ndarray,
    values: list[list[float]] | np.ndarray,
    skipped: int = 0,
) -> StampedDrive:
    values = np.array(values, dtype=float).reshape(len(stamps), len(channels))
    known = np.flatnonzero(~np.isnan(values).all(axis=1))
    count = known[-1] + 1 if known.size else len(stamps)
    ended_ns = int(stamps[count]) if count < len(stamps) else None
    stamps, values = stamps[:count], values[:count]
    bad = np.flatnonzero(~np.isfinite(values).all(axis=1))
    if bad.size:
        units = "/".join(dict.fromkeys(channel.unit for channel in channels))
        raise RecordingError(
            f"{file.path}: message {skipped + bad[0] + 1} on {topic} commands {values[bad[0]].tolist()} {units}, "
            "but numbers are expected: was the supply in a fault? Record the run again."
        )
    return StampedDrive(topic, channels, stamps, values, ended_ns)
