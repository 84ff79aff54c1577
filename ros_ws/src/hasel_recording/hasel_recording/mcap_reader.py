"""Read a run from the messages of an MCAP file."""

import warnings
from itertools import compress
from pathlib import Path
from typing import Any

import numpy as np

from hasel_recording.errors import RecordingError, RecordingWarning, nearest
from hasel_recording.mcap_file import McapFile, read_file
from hasel_recording.mcap_recorder import HEADER_RECORD, TIME_RECORD
from hasel_recording.message_fields import nanoseconds
from hasel_recording.recording import Recording
from hasel_recording.topics import MARKERS, MEASURED, SIMULATED, STATE, TOPIC_TYPES


def read_mcap(path: Path) -> Recording:
    """Read one run, sampled at the stamps of the measured angle.

    Frames before the first supply state, whose voltage is not known, are left out with a RecordingWarning.
    """
    file = read_file(path)
    measured, frame_ns = _messages(file, MEASURED)
    if not measured:
        raise file.missing(MEASURED)
    states, state_ns = _messages(file, STATE)
    if not states and nearest(STATE, set(file.messages) - set(TOPIC_TYPES)):
        raise file.missing(STATE)
    first_ns = int(np.concatenate([frame_ns[:1], state_ns[:1]]).min())
    origin = int(file.metadata.get(TIME_RECORD, {}).get("time_origin_ns", first_ns))
    driven = frame_ns >= state_ns[0] if states else np.ones(len(frame_ns), dtype=bool)
    _warn_of_undriven(path, driven)
    markers, unit = _markers(file, measured, frame_ns)
    simulated, simulated_ns = _messages(file, SIMULATED)
    return Recording(
        name=path.stem,
        path=path,
        metadata=file.metadata.get(HEADER_RECORD, {}),
        time_s=_seconds(frame_ns, origin)[driven],
        sin_theta=_angles(measured)[driven],
        markers=None if markers is None else markers[driven],
        marker_unit=unit,
        **_drive(path, states, state_ns, frame_ns[driven], origin),
        simulated_time_s=_seconds(simulated_ns, origin) if simulated else None,
        simulated_sin_theta=_angles(simulated) if simulated else None,
    )


def _messages(file: McapFile, topic: str) -> tuple[list[Any], np.ndarray]:
    """Return a topic's messages and their stamps [ns], which must increase.

    A supply may repeat its state with the same stamp; the last one counts.
    """
    messages = file.decoded(topic, TOPIC_TYPES[topic])
    stamps = np.array([nanoseconds(message.header.stamp) for message in messages], dtype=np.int64)
    if topic == STATE:
        last = np.append(np.diff(stamps) != 0, True)[: len(stamps)]
        messages, stamps = list(compress(messages, last)), stamps[last]
    late = np.flatnonzero(np.diff(stamps) <= 0)
    if late.size:
        raise RecordingError(
            f"{file.path}: message {late[0] + 2} on {topic} is not later than the one before; "
            "was the topic published by two nodes, or the clock set during the run?"
        )
    return messages, stamps


def _seconds(stamps_ns: np.ndarray, origin_ns: int) -> np.ndarray:
    return (stamps_ns - origin_ns) / 1e9


def _angles(messages: list[Any]) -> np.ndarray:
    return np.array([message.sin_theta if message.valid else np.nan for message in messages])


def _warn_of_undriven(path: Path, driven: np.ndarray) -> None:
    if not driven.any():
        raise RecordingError(
            f"{path}: every frame comes before the first {STATE}: start the driver before the run."
        )
    if not driven.all():
        warnings.warn(
            f"{path}: {np.count_nonzero(~driven)} frames before the first {STATE} were left out.",
            RecordingWarning,
            stacklevel=4,
        )


def _drive(
    path: Path, states: list[Any], state_ns: np.ndarray, frame_ns: np.ndarray, origin: int
) -> dict[str, np.ndarray]:
    """Return the voltage at the frames and, where it switches between frames, the instants of switching."""
    if not states:
        return {}
    voltage = np.array([state.commanded_voltage for state in states], dtype=float)
    bad = np.flatnonzero(~np.isfinite(voltage).all(axis=1))
    if bad.size:
        raise RecordingError(
            f"{path}: message {bad[0] + 1} on {STATE} commands {voltage[bad[0]].tolist()} V, "
            "but two numbers are expected: was the supply in a fault? Record the run again."
        )
    changes = np.concatenate([[0], 1 + np.flatnonzero(np.any(np.diff(voltage, axis=0) != 0, axis=1))])
    sampled = {"drive_signal": voltage[np.searchsorted(state_ns, frame_ns, side="right") - 1]}
    if np.isin(state_ns[changes], frame_ns).all():
        return sampled
    return sampled | {"drive_time_s": _seconds(state_ns[changes], origin), "drive_values": voltage[changes]}


def _markers(file: McapFile, measured: list[Any], frame_ns: np.ndarray) -> tuple[np.ndarray | None, str]:
    """Return the markers [n, 3, 2] and their unit: metres from their own topic, else the angle's pixels."""
    poses, pose_ns = _messages(file, MARKERS)
    if poses:
        at_frame = {
            stamp: [[p.position.x, p.position.y] for p in m.poses]
            for stamp, m in zip(pose_ns, poses, strict=True)
        }
        lost = [[np.nan, np.nan]] * 3
        return np.array([at_frame.get(stamp, lost) for stamp in frame_ns]), "m"
    if not len(measured[0].marker_x):
        return None, "m"
    pixels = np.array([[m.marker_x, m.marker_y] for m in measured]).transpose(0, 2, 1)
    return (pixels, "px") if np.isfinite(pixels).any() else (None, "m")
