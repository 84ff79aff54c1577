# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Faults of the header lines and of the frames' times: order, unit, gaps, jitter, rate."""

import numpy as np
from hasel_common.names import nearest
from hasel_recording import Recording
from hasel_recording.recording import KNOWN_KEYS

from hasel_sysid.data_quality.finding import DataFinding, error, warning

_FEWEST_FRAMES = 16
_MOST_JITTER = 0.2
_MANY_DROPPED = 0.2
_LOWEST_RATE_HZ = 25.0
_SHORTEST_STEP_S, _LONGEST_STEP_S = 5e-5, 0.5
_LONGEST_RUN_S = 3600.0
_SMALLER_UNITS = {"ms": 1e-3, "us": 1e-6, "ns": 1e-9}
_CHANCE = 3.0


def check_header(recording: Recording) -> list[DataFinding]:
    """Values that are not understood, and keys that resemble a known one; any other key is kept as a note."""
    found = [*_header_numbers(recording)]
    for key in recording.metadata:
        near = nearest(key, KNOWN_KEYS, similarity=0.85)
        if key not in KNOWN_KEYS and near and not key.startswith("volts_per_"):
            evidence = f"the header has '{key}', which is not known"
            found.append(warning("misspelt header", 1.0, evidence, f"did you mean '{near}'?"))
    return found


def _header_numbers(recording: Recording) -> list[DataFinding]:
    found = []
    for key in ("initial_time_s", "initial_load_factor"):
        try:
            value = float(recording.metadata.get(key, "0"))
        except ValueError:
            evidence = f"{key} is '{recording.metadata[key]}', expected a number"
            found.append(error("header value", 1.0, evidence, "correct the header line"))
            continue
        if key == "initial_time_s" and key in recording.metadata and value > recording.time_s[-1]:
            evidence = (
                f"the body is let go at {value:g} s and the last frame is at {recording.time_s[-1]:g} s"
            )
            found.append(error("header value", value, evidence, "correct initial_time_s"))
    return found


def check_frames(recording: Recording) -> list[DataFinding]:
    """Faults of the times alone."""
    time = recording.time_s
    seen = int(recording.valid.sum())
    if seen < _FEWEST_FRAMES:
        evidence = f"{seen} of {len(time)} frames have an angle, expected {_FEWEST_FRAMES} at least"
        return [error("too few frames", seen, evidence, "record at least one period")]
    steps = np.diff(time)
    backwards = int(np.count_nonzero(steps <= 0))
    if backwards:
        return [
            error(
                "time order",
                backwards,
                f"{backwards} frames do not come after the one before",
                "sort the rows by time, or record with one clock",
            )
        ]
    return _unit(steps) or [*_length(time), *_gaps(steps), *_jitter(steps), *_rate(steps)]


def _unit(steps: np.ndarray) -> list[DataFinding]:
    usual = float(np.median(steps))
    if usual < _SHORTEST_STEP_S:
        evidence = f"frames are {usual:.3g} s apart, {1 / usual:.6g} per second, which no camera takes"
        advice = "is the time in a larger unit? then call its column time_s or time_ms, or give --map time_s=COLUMN"
        return [error("unit of time", usual, evidence, advice)]
    if usual < _LONGEST_STEP_S:
        return []
    likely = [unit for unit, size in _SMALLER_UNITS.items() if 0.5e-3 <= usual * size < _LONGEST_STEP_S]
    evidence = f"frames are {usual:.4g} s apart, expected less than {_LONGEST_STEP_S:g} s"
    unit = likely[0] if likely else "ms"
    advice = f"is the time in {unit}? then call its column time_{unit}, or give --map time_{unit}=COLUMN"
    return [error("unit of time", usual, evidence, advice)]


def _length(time: np.ndarray) -> list[DataFinding]:
    duration = float(time[-1] - time[0])
    if duration <= _LONGEST_RUN_S:
        return []
    evidence = (
        f"the run lasts {duration / 3600:.3g} h with {len(time)} frames, every one of which is simulated"
    )
    return [
        error("run of hours", duration, evidence, "cut out the minutes that matter, or check the time's unit")
    ]


def _gaps(steps: np.ndarray) -> list[DataFinding]:
    """Missing frames; a long step that a short one makes up for is a late stamp, not a missing frame."""
    usual = float(np.median(steps))
    late = np.count_nonzero(steps < 0.5 * usual)
    missing = int(np.round(steps / usual - 1)[steps > 1.5 * usual].sum()) - late
    if missing <= _CHANCE * np.sqrt(late):
        return []
    make = error if missing > _MANY_DROPPED * (len(steps) + missing) else warning
    evidence = f"{missing} frames are missing, the longest gap is {steps.max() * 1e3:.0f} ms"
    return [make("dropped frames", missing, evidence, "record with less load, or a lower frame rate")]


def _jitter(steps: np.ndarray) -> list[DataFinding]:
    usual = float(np.median(steps))
    jitter = float(np.std(steps[steps <= 1.5 * usual]) / usual)
    if jitter <= _MOST_JITTER:
        return []
    evidence = f"the distance of frames varies by {jitter:.0%} (standard deviation)"
    return [warning("jitter", jitter, evidence, "stamp frames when they are exposed, not when they arrive")]


def _rate(steps: np.ndarray) -> list[DataFinding]:
    rate = float(1 / np.median(steps))
    if rate >= _LOWEST_RATE_HZ or rate <= 2:
        return []
    evidence = f"there are {rate:.3g} frames per second"
    return [warning("frame rate", rate, evidence, f"record at least {_LOWEST_RATE_HZ:g} frames per second")]
