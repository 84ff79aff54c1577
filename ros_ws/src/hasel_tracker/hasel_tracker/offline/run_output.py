# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Write a tracked run as a recording that compare, fit and diagnose read."""

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
from hasel_common.topics import DRIVE, MEASURED, STATE
from hasel_recording import (
    HASEL_PAIR,
    DriveChannel,
    McapRecorder,
    Recording,
    RecordingError,
    RecordingWarning,
    write_recording,
)
from hasel_recording.mcap_run import state_message
from hasel_recording.ros_messages import bending_angle_message

from hasel_tracker.errors import TrackerError
from hasel_tracker.offline.drive import Drive, DriveAlignment, after_the_drive
from hasel_tracker.offline.tracked_run import TrackedRun
from hasel_tracker.tracking.marker_set import marker_names

AT_FRAME_S = 1e-6
AFTER_S = 2e-9  # what is known still holds at the end itself


def write_run(
    path: Path,
    run: TrackedRun,
    drive: Drive | None,
    alignment: DriveAlignment | None,
    metadata: dict[str, str],
) -> str:
    """Write .csv or .mcap; times start at the run's first frame. Returns what could not be kept, or ''."""
    origin = float(run.time_s[0])
    shifted, ended = None, ""
    if drive is not None:
        ended = after_the_drive(run, drive, alignment)
        shifted = replace(drive, time_s=drive.time_s + alignment.lag_s - origin)
        metadata = metadata | {"drive_lag_s": f"{alignment.lag_s:.6f}", "drive_merged": alignment.means}
    try:
        if path.suffix.lower() == ".mcap":
            _write_mcap(path, run, shifted, metadata)
            return ended
        return f"{ended} {_write_csv(path, run, shifted, metadata)}".strip()
    except RecordingError as error:
        raise TrackerError(str(error)) from error


def _write_csv(path: Path, run: TrackedRun, drive: Drive | None, metadata: dict[str, str]) -> str:
    time_s = run.time_s - run.time_s[0]
    signal, channels = (None, HASEL_PAIR) if drive is None else (drive.at(time_s), drive.channels)
    when, values = (None, None) if drive is None else _switches(drive, time_s)
    markers, unit = (run.markers_px, "px") if run.markers_m is None else (run.markers_m, "m")
    names = marker_names(markers.shape[1])
    recording = Recording(
        path.stem,
        time_s,
        run.sin_theta,
        signal,
        markers,
        unit,
        metadata,
        channels=channels,
        marker_names=names,
        drive_time_s=when,
        drive_values=values,
    )
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", RecordingWarning)
        write_recording(recording, path)
    return " ".join(str(each.message) for each in caught)


def _switches(drive: Drive, time_s: np.ndarray) -> tuple[np.ndarray | None, np.ndarray | None]:
    """When the drive changes and to what, for a Recording; None, None where that is at frames."""
    when = _changes(drive, time_s[-1])
    if np.abs(when[:, None] - time_s).min(axis=1).max() < AT_FRAME_S:
        return None, None
    return when, drive.at(when)


def _changes(drive: Drive, end_s: float) -> np.ndarray:
    """The start of the run and every later row of the drive up to its end [s]."""
    return np.concatenate([[0.0], drive.time_s[(drive.time_s > 0.0) & (drive.time_s <= end_s)]])


def _write_mcap(path: Path, run: TrackedRun, drive: Drive | None, metadata: dict[str, str]) -> None:
    time_s = run.time_s - run.time_s[0]
    messages = [(float(when), MEASURED, _angle(run, index)) for index, when in enumerate(time_s)]
    if drive is not None:
        messages += _drive_messages(drive, time_s[-1])
    start_ns = (run.start_stamp_ns or 0) + round(float(run.time_s[0]) * 1e9) if run.start_stamp_ns else 0
    with McapRecorder(path, metadata, time_origin_ns=start_ns) as recorder:
        for when, topic, message in sorted(messages, key=lambda each: each[0]):
            recorder.write(topic, message, start_ns + round(when * 1e9))


def _angle(run: TrackedRun, index: int) -> dict[str, object]:
    return bending_angle_message(
        float(run.sin_theta[index]),
        float(run.theta[index]),
        float("nan") if run.sin_theta_std is None else float(run.sin_theta_std[index]),
        marker_names(run.markers_px.shape[1]),
        run.markers_px[index],
        None if run.markers_m is None else run.markers_m[index],
        run.quality[index],
        0 if run.doubt is None else int(run.doubt[index]),
    )


def _drive_messages(drive: Drive, end_s: float) -> list[tuple[float, str, dict[str, object]]]:
    """The drive at the start, every change of it up to the end of the run, and from where on it is not known."""
    ends = [] if drive.end_s >= end_s else [max(drive.end_s, 0.0) + AFTER_S]
    times = np.concatenate([_changes(drive, end_s), ends])
    return [
        (float(when), *_drive_message(drive.channels, values.tolist()))
        for when, values in zip(times, drive.at(times), strict=True)
    ]


def _drive_message(channels: tuple[DriveChannel, ...], values: list[float]) -> tuple[str, dict[str, object]]:
    if channels == HASEL_PAIR:
        return STATE, state_message(values)
    return DRIVE, {"channel": [channel.column for channel in channels], "value": values}
