# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Motions from files: centre lines, markers, or a bending angle alone."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import numpy as np
from hasel_recording import Recording, RecordingError, read_recording
from hasel_recording.csv_columns import Column
from hasel_recording.csv_numbers import CsvNumbers
from hasel_recording.csv_text import read_text
from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.marker_set import bending_angle

from hasel_tracker_lab.rendering.swimmer_motion import (
    BendingMotion,
    BodyShape,
    SampledMotion,
    line_through_markers,
)

LINE_COLUMN = re.compile(r"centre_(\d+)_([xy])_m")
BEND_SAMPLES = np.linspace(-2.8, 2.8, 201)
_Read = TypeVar("_Read")


def read_motion(path: Path, shape: BodyShape) -> SampledMotion:
    """Read a motion; raises TrackerError.

    A .csv with the columns `time_s, centre_0_x_m, centre_0_y_m, centre_1_x_m, …` gives the centre line from
    nose to fin tip at equal material distances. Any other recording (.csv, .mcap) gives the markers in
    metres, or else sin θ.
    """
    path = Path(path)
    if (
        path.suffix.lower() == ".csv"
        and path.is_file()
        and "centre_0_x_m" in path.read_text(errors="replace")
    ):
        return _told(_centre_lines, path)
    recording = _told(read_recording, path)
    seen = recording.valid
    if seen.sum() < 2:
        raise TrackerError(f"{path} has {int(seen.sum())} frames with an angle; a motion needs at least two.")
    if recording.markers is not None and recording.marker_unit == "m":
        lines = np.array([line_through_markers(each, shape) for each in recording.markers[seen]])
    else:
        lines = _lines_of_angle(recording, shape)
    return SampledMotion(recording.time_s[seen], lines - lines.mean(axis=(0, 1)))


def _told(read: Callable[[Path], _Read], path: Path) -> _Read:
    """What is read; a recording's error as one of the tracker's."""
    try:
        return read(path)
    except RecordingError as error:
        raise TrackerError(str(error)) from error


def bend_of(sin_theta: np.ndarray, shape: BodyShape) -> np.ndarray:
    """Angle from head to tail [rad] at which a uniformly bent body has these sin θ, same shape."""
    angles = []
    for bend in BEND_SAMPLES:
        motion = BendingMotion(shape=shape)
        markers = motion.markers_when_bent(bend)
        angles.append(bending_angle(markers * [1.0, -1.0])[1])
    return np.interp(np.arcsin(np.clip(sin_theta, -1.0, 1.0)), angles, BEND_SAMPLES)


def _lines_of_angle(recording: Recording, shape: BodyShape) -> np.ndarray:
    motion = BendingMotion(shape=shape)
    bends = bend_of(recording.sin_theta[recording.valid], shape)
    return np.array([motion.line_when_bent(bend) for bend in bends])


def _centre_lines(path: Path) -> SampledMotion:
    text = read_text(path)
    points = {(int(m[1]), m[2]): name for name in text.names if (m := LINE_COLUMN.fullmatch(name))}
    count = len(points) // 2
    wanted = {(number, axis) for number in range(count) for axis in "xy"}
    if "time_s" not in text.names or set(points) != wanted or count < 4:
        raise TrackerError(
            f"{path} does not hold whole centre lines; expected time_s and centre_0_x_m, centre_0_y_m, "
            "centre_1_x_m … for at least four points."
        )
    numbers = CsvNumbers(text)
    times = numbers.times(Column("time_s", 1.0))
    if len(times) < 2:
        raise TrackerError(f"{path} has one row; a motion needs at least two.")
    lines = [[numbers.column(Column(points[n, axis], 1.0)) for axis in "xy"] for n in range(count)]
    return SampledMotion(times, np.moveaxis(np.array(lines), -1, 0))
