# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A run as the messages of an MCAP file or bag: read, and written as they would have been recorded live."""

import heapq
import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import compress
from pathlib import Path
from typing import Any

import numpy as np
from hasel_common.names import nearest
from hasel_common.topics import DRIVE, MARKERS, MEASURED, SIMULATED, STATE, TOPIC_TYPES

from hasel_recording.bag import McapFile, read_bag
from hasel_recording.drive_channel import HASEL_PAIR, DriveChannel, as_meant, parse_column
from hasel_recording.errors import RecordingError, warn
from hasel_recording.mcap_recorder import HEADER_RECORD, TIME_RECORD, McapRecorder
from hasel_recording.recording import MARKER_NAMES, Recording, row_in_force
from hasel_recording.ros_messages import bending_angle_message, nanoseconds

ACTIVE = 2  # SupplyState.ACTIVE
UNKNOWN_PAIR = [math.nan] * 2


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


def read_mcap(path: Path) -> Recording:
    """Read one run, sampled at the stamps of the measured angle.

    Frames before the first known drive, and from its end on, are left out with a RecordingWarning.
    """
    file = read_bag(path)
    measured, frame_ns = stamped_messages(file, MEASURED)
    if not measured:
        raise file.missing(MEASURED)
    drive = stamped_drive(file)
    if drive is None and nearest(STATE, set(file.messages) - set(TOPIC_TYPES)):
        raise file.missing(STATE)
    driven = _driven(path, frame_ns, drive)
    origin = time_origin(file, frame_ns[:1] if drive is None else np.append(frame_ns[:1], drive.stamps[:1]))
    markers, unit, names = _markers(file, measured, frame_ns)
    simulated, simulated_ns = stamped_messages(file, SIMULATED)
    metadata = file.metadata.get(HEADER_RECORD, {})
    return Recording(
        name=path.name if path.is_dir() else path.stem,
        path=path,
        metadata=metadata,
        time_s=seconds(frame_ns, origin)[driven],
        sin_theta=_angles(measured)[driven],
        markers=None if markers is None else markers[driven],
        marker_unit=unit,
        marker_names=names,
        simulated_time_s=seconds(simulated_ns, origin) if simulated else None,
        simulated_sin_theta=_angles(simulated) if simulated else None,
        **({} if drive is None else _at_frames(path, metadata, drive, frame_ns[driven], origin)),
    )


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
    topic = DRIVE
    messages, stamps = stamped_messages(file, DRIVE)
    named = [(list(message.channel), message.value) for message in messages]
    if not messages:
        topic = STATE
        messages, stamps = stamped_messages(file, STATE)
        named = [(muscles(message), message.commanded_voltage) for message in messages]
    if not messages:
        return None
    names = named[0][0]
    for number, (others, values) in enumerate(named, start=1):
        if others != names or len(values) != len(names):
            raise RecordingError(
                f"{file.path}: message {number} on {topic} has {len(values)} values for {', '.join(others)}, "
                f"but {', '.join(names)} are expected: publish the same channels always."
            )
    channels = tuple(
        _channel(file, name) if topic == DRIVE else DriveChannel(name, "voltage", "V") for name in names
    )
    table = np.array([values for _, values in named], dtype=float).reshape(len(stamps), len(channels))
    first = int(np.argmax(np.isfinite(table).all(axis=1))) if topic == STATE else 0
    known = np.flatnonzero(~np.isnan(table).all(axis=1))
    end = known[-1] + 1 if known.size else len(stamps)
    bad = first + np.flatnonzero(~np.isfinite(table[first:end]).all(axis=1))
    if bad.size:
        units = "/".join(dict.fromkeys(channel.unit for channel in channels))
        raise RecordingError(
            f"{file.path}: message {bad[0] + 1} on {topic} commands {table[bad[0]].tolist()} {units}, "
            "but numbers are expected: was the supply in a fault? Record the run again."
        )
    ended_ns = int(stamps[end]) if end < len(stamps) else None
    return StampedDrive(topic, channels, stamps[first:end], table[first:end], ended_ns)


def muscles(state: Any) -> list[str]:
    """Return the names of a SupplyState's muscles; one without names, as of old, has the rig's two."""
    return list(getattr(state, "muscle", ())) or [channel.name for channel in HASEL_PAIR]


def _channel(file: McapFile, name: str) -> DriveChannel:
    try:
        channel, factor = parse_column(name)
    except RecordingError as error:
        raise RecordingError(f"{file.path}: {DRIVE}: {error}") from None
    if factor != 1.0:
        raise RecordingError(
            f"{file.path}: {DRIVE} has {name}, expected the SI unit, {channel.column}: convert it."
        )
    return channel


def time_origin(file: McapFile, stamps: np.ndarray) -> int:
    """Return the stamp [ns] that is time 0 of a run: what the file says, else the earliest of `stamps`."""
    said = file.metadata.get(TIME_RECORD, {}).get("time_origin_ns", "")
    return int(said) if said.isdecimal() else int(stamps.min())


def seconds(stamps_ns: np.ndarray, origin_ns: int) -> np.ndarray:
    """Return stamps [ns] as times [s] after the origin."""
    return (stamps_ns - origin_ns) / 1e9


def _angles(messages: list[Any]) -> np.ndarray:
    return np.array([message.sin_theta if message.valid else np.nan for message in messages])


def _driven(path: Path, frame_ns: np.ndarray, drive: StampedDrive | None) -> np.ndarray:
    """Return in which frames the drive is known, [n]; says which are left out."""
    if drive is None:
        return np.ones(len(frame_ns), dtype=bool)
    early = frame_ns < drive.stamps[0]
    late = np.zeros_like(early) if drive.ended_ns is None else frame_ns >= drive.ended_ns
    if (early | late).all():
        raise RecordingError(
            f"{path}: no frame comes while the values on {drive.topic} are known: start the driver before the run."
        )
    for left_out, where in ((early, f"before the first {drive.topic}"), (late, "after the drive's end")):
        if left_out.any():
            warn(
                f"{path}: {np.count_nonzero(left_out)} frames {where} were left out: what drove the body then is not "
                "known."
            )
    return ~(early | late)


def _at_frames(
    path: Path, metadata: dict[str, str], drive: StampedDrive, frame_ns: np.ndarray, origin: int
) -> dict[str, Any]:
    """Return the drive at the frames and, where it switches between frames, the instants of switching."""
    channels, values, stand_in = as_meant(drive.channels, drive.values, metadata, str(path))
    sampled = {
        "channels": channels,
        "drive_signal": values[row_in_force(drive.stamps, frame_ns)],
        "understood": (stand_in,) if stand_in else (),
    }
    changes = np.append(0, 1 + np.flatnonzero(np.any(np.diff(values, axis=0) != 0, axis=1)))
    if np.isin(drive.stamps[changes], frame_ns).all():
        return sampled
    return sampled | {
        "drive_time_s": seconds(drive.stamps[changes], origin),
        "drive_values": values[changes],
    }


def _markers(
    file: McapFile, measured: list[Any], frame_ns: np.ndarray
) -> tuple[np.ndarray | None, str, tuple[str, ...]]:
    """Return the markers [n, m, 2], their unit, metres before pixels, and their names."""
    poses, pose_ns = stamped_messages(file, MARKERS)
    if poses:
        at_frame = {
            stamp: [[p.position.x, p.position.y] for p in m.poses]
            for stamp, m in zip(pose_ns, poses, strict=True)
        }
        lost = [[np.nan, np.nan]] * len(MARKER_NAMES)
        return np.array([at_frame.get(stamp, lost) for stamp in frame_ns]), "m", MARKER_NAMES
    names = tuple(getattr(measured[0], "marker_name", MARKER_NAMES))
    for unit, fields in (("m", ("marker_x_m", "marker_y_m")), ("px", ("marker_x", "marker_y"))):
        coordinates = [[getattr(message, field, ()) for field in fields] for message in measured]
        if {len(axis) for pair in coordinates for axis in pair} - {len(names)}:
            continue
        positions = np.moveaxis(np.reshape(coordinates, (len(measured), 2, len(names))), 1, 2).astype(float)
        if np.isfinite(positions).any():
            return positions, unit, names
    return None, "m", MARKER_NAMES


def write_mcap(recording: Recording, path: Path) -> None:
    """Write one run; times are kept to the nanosecond, every other number exactly."""
    streams = [_drive(recording), _measured(recording)]
    earliest_s = min(recording.time_s[0], recording.recorded_drive()[0][0])
    if recording.simulated_time_s is not None:
        streams.append(_simulated(recording))
        earliest_s = min(earliest_s, recording.simulated_time_s[0])
    origin = max(0, -_nanoseconds(earliest_s))  # stamps in an MCAP file cannot be negative
    with McapRecorder(path, recording.metadata, time_origin_ns=origin) as recorder:
        for time_ns, topic, message in heapq.merge(*streams, key=lambda item: item[0]):
            recorder.write(topic, message, origin + time_ns)


def _nanoseconds(time_s: float) -> int:
    return round(time_s * 1e9)


def _drive(recording: Recording) -> Iterator[tuple[int, str, dict[str, Any]]]:
    if not recording.driven:
        return
    columns = [channel.column for channel in recording.channels]
    supply = recording.channels == HASEL_PAIR
    for time, values in zip(*recording.recorded_drive(), strict=True):
        message = state_message(values.tolist()) if supply else {"channel": columns, "value": values.tolist()}
        yield _nanoseconds(time), STATE if supply else DRIVE, message


def state_message(voltage: list[float]) -> dict[str, Any]:
    """A supply's state of which only the commanded voltage [V] is known, as a mapping that McapRecorder writes."""
    return {
        "muscle": [channel.name for channel in HASEL_PAIR],
        "commanded_voltage": voltage,
        "measured_voltage": UNKNOWN_PAIR,
        "current": UNKNOWN_PAIR,
        "mode": ACTIVE,
        "fault_code": 0,
        "fault_text": "",
        "grounded": False,
        "ground": 0,
        "interlock": [0, 0],
        "emergency_stop_holders": [],
        **dict.fromkeys(("maximum_voltage", "slew_rate", "trip_current", "heartbeat_timeout"), math.nan),
        "commander": "",
    }


def _measured(recording: Recording) -> Iterator[tuple[int, str, dict[str, Any]]]:
    kind = "pixels" if recording.marker_unit == "px" else "metres"
    for index, (time, sine) in enumerate(zip(recording.time_s, recording.sin_theta.tolist(), strict=True)):
        markers = {}
        if recording.markers is not None:
            markers = {"marker_names": recording.marker_names, kind: recording.markers[index]}
        yield _nanoseconds(time), MEASURED, bending_angle_message(sine, **markers)


def _simulated(recording: Recording) -> Iterator[tuple[int, str, dict[str, Any]]]:
    if recording.simulated_time_s is None or recording.simulated_sin_theta is None:
        return
    for time, sine in zip(recording.simulated_time_s, recording.simulated_sin_theta.tolist(), strict=True):
        yield _nanoseconds(time), SIMULATED, bending_angle_message(sine)
