"""Write a run as the messages that would have been recorded live."""

import heapq
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hasel_common.topics import DRIVE, MEASURED, SIMULATED, STATE

from hasel_recording.bending_angle_message import bending_angle_message
from hasel_recording.drive_channel import HASEL_PAIR
from hasel_recording.mcap_recorder import McapRecorder
from hasel_recording.recording import Recording

ACTIVE = 2  # SupplyState.ACTIVE
UNKNOWN_PAIR = [math.nan] * 2


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
        "maximum_voltage": math.nan,
        "slew_rate": math.nan,
        "trip_current": math.nan,
        "heartbeat_timeout": math.nan,
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
    for time, sine in zip(recording.simulated_time_s, recording.simulated_sin_theta.tolist(), strict=True):
        yield _nanoseconds(time), SIMULATED, bending_angle_message(sine)
