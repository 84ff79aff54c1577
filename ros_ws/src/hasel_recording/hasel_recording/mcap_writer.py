"""Write a run as the messages that would have been recorded live."""

import heapq
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from hasel_recording.bending_angle_message import bending_angle_message
from hasel_recording.mcap_recorder import McapRecorder
from hasel_recording.recording import MARKER_NAMES, Recording
from hasel_recording.topics import MARKERS, MEASURED, SIMULATED, STATE

ACTIVE = 2  # SupplyState.ACTIVE
UNKNOWN_PAIR = [math.nan] * 2


def write_mcap(recording: Recording, path: Path) -> None:
    """Write one run; times are kept to the nanosecond, every other number exactly."""
    streams = [
        _states(recording),
        _markers(recording),
        _angles(MEASURED, recording.time_s, recording.sin_theta, _pixels(recording)),
    ]
    earliest_s = min(recording.time_s[0], recording.drive()[0][0])
    if recording.simulated_time_s is not None:
        streams.append(_angles(SIMULATED, recording.simulated_time_s, recording.simulated_sin_theta))
        earliest_s = min(earliest_s, recording.simulated_time_s[0])
    origin = max(0, -_nanoseconds(earliest_s))  # stamps in an MCAP file cannot be negative
    with McapRecorder(path, recording.metadata, time_origin_ns=origin) as recorder:
        for time_ns, topic, message in heapq.merge(*streams, key=lambda item: item[0]):
            recorder.write(topic, message, origin + time_ns)


def _nanoseconds(time_s: float) -> int:
    return round(time_s * 1e9)


def _states(recording: Recording) -> Iterator[tuple[int, str, dict[str, Any]]]:
    if recording.voltage is None:
        return
    for time, voltage in zip(*recording.drive(), strict=True):
        yield (
            _nanoseconds(time),
            STATE,
            {
                "commanded_voltage": voltage.tolist(),
                "measured_voltage": UNKNOWN_PAIR,
                "current": UNKNOWN_PAIR,
                "mode": ACTIVE,
                "fault_code": 0,
                "fault_text": "",
            },
        )


def _pixels(recording: Recording) -> np.ndarray | None:
    return recording.markers if recording.marker_unit == "px" else None


def _angles(
    topic: str, time_s: np.ndarray, sin_theta: np.ndarray, pixels: np.ndarray | None = None
) -> Iterator[tuple[int, str, dict[str, Any]]]:
    for index, (time, sine) in enumerate(zip(time_s, sin_theta.tolist(), strict=True)):
        yield (
            _nanoseconds(time),
            topic,
            bending_angle_message(
                sine, marker_names=MARKER_NAMES, pixels=None if pixels is None else pixels[index]
            ),
        )


def _markers(recording: Recording) -> Iterator[tuple[int, str, dict[str, Any]]]:
    if recording.markers is None or recording.marker_unit != "m":
        return
    upright = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
    for time, markers in zip(recording.time_s, recording.markers.tolist(), strict=True):
        poses = [{"position": {"x": x, "y": y, "z": 0.0}, "orientation": upright} for x, y in markers]
        yield _nanoseconds(time), MARKERS, {"poses": poses}
