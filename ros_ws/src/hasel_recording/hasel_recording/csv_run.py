# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A run as a CSV file, as labs write it and as we do: `#key: value` lines, a row of column names, one row per frame."""

import csv
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from hasel_recording.csv_columns import SIN_THETA, Columns, marker_columns, meant_names, understand
from hasel_recording.csv_numbers import NOT_MEASURED, CsvNumbers
from hasel_recording.csv_text import CsvText, read_text
from hasel_recording.drive_channel import HASEL_PAIR, DriveChannel, as_meant
from hasel_recording.errors import RecordingError, warn
from hasel_recording.recording import DRIVE_KEY, MARKER_NAMES, Recording, sin_theta_from_markers

SEPARATED_BY = {";": "semicolons", "\t": "tabs", " ": "blanks"}


def read_csv(path: Path, mapping: Mapping[str, str] | None = None, own_drive: bool = True) -> Recording:
    """Read one run; raises RecordingError naming the line and column of what is wrong.

    mapping: {name that is known here: the file's own column}, as of csv_columns.parse_map. own_drive: False where the
    drive is in another file, to which some of the mapping belongs.
    """
    text = read_text(path)
    columns = understand(text.names, meant_names(mapping or {}, text.names, str(path), own_drive), str(path))
    for name in columns.unused:
        warn(f"{path}: column {name!r} is not used; --map says what a column is.")
    text = _until_drive_ends(text, columns)
    numbers = CsvNumbers(text)
    time_s = numbers.times(columns.time)
    markers = _markers(columns, numbers)
    sin_theta = _angle(columns, numbers, markers)
    if not np.isfinite(sin_theta).any():
        raise RecordingError(
            f"{path} has no frame with an angle: fill in the column, or track the markers again."
        )
    channels, values, stand_in = drive_columns(columns, numbers, text)
    return Recording(
        name=path.stem,
        path=path,
        metadata=text.metadata,
        time_s=time_s,
        drive_signal=values,
        sin_theta=sin_theta,
        markers=markers if columns.markers else None,
        marker_unit=columns.marker_unit,
        channels=channels,
        marker_names=columns.marker_names or MARKER_NAMES,
        understood=(*_understood(columns, text), *filter(None, [stand_in])),
    )


def drive_columns(
    columns: Columns, numbers: CsvNumbers, text: CsvText
) -> tuple[tuple[DriveChannel, ...], np.ndarray | None, str]:
    """Return the channels, their values [n, channels] in SI units (None: passive), and what volts stand for.

    The rig's two voltages come upper first, whatever the order of their columns.
    """
    channels = tuple(columns.drive)
    if not channels:
        return HASEL_PAIR, None, ""
    if set(channels) == set(HASEL_PAIR):
        channels = HASEL_PAIR
    values = np.column_stack([numbers.column(columns.drive[channel]) for channel in channels])
    return as_meant(channels, values, text.metadata, str(text.path))


def _markers(columns: Columns, numbers: CsvNumbers) -> np.ndarray:
    """Return the markers [n, m, 2]; NaN where one was not seen."""
    if not columns.markers:
        return np.empty((0, 0, 2))
    table = [numbers.column(column, may_be_missing=True) for column in columns.markers]
    return np.column_stack(table).reshape(len(table[0]), -1, 2)


def _angle(columns: Columns, numbers: CsvNumbers, markers: np.ndarray) -> np.ndarray:
    if columns.sin_theta:
        return numbers.column(columns.sin_theta, may_be_missing=True)
    if columns.theta:
        return np.sin(numbers.column(columns.theta, may_be_missing=True))
    three = markers[:, [columns.marker_names.index(name) for name in MARKER_NAMES]]
    return sin_theta_from_markers(three * (1, -1) if columns.marker_unit == "px" else three)


def _understood(columns: Columns, text: CsvText) -> list[str]:
    """Which column is read as what, one sentence each; those that mean what they are called are left out."""
    said = [f"columns {', '.join(name for name in text.names if name not in columns.unused)}"]
    if text.separator != ",":
        said.append(f"cells are separated by {SEPARATED_BY[text.separator]}")
    if columns.time.factor != 1 or columns.time.name != "time_s":
        said.append(f"time is column {columns.time.name!r}, times {columns.time.factor:g} in s")
    if columns.theta:
        said.append(
            f"sin θ is the sine of column {columns.theta.name!r}, times {columns.theta.factor:g} in rad"
        )
    elif columns.sin_theta and columns.sin_theta.name != "sin_theta":
        said.append(f"sin θ is column {columns.sin_theta.name!r}")
    elif not columns.sin_theta:
        said.append(f"sin θ comes from the markers {', '.join(MARKER_NAMES)}")
    for channel, column in columns.drive.items():
        if column.name != channel.column:
            said.append(f"{channel} is column {column.name!r}, times {column.factor:g}")
    return said


def _until_drive_ends(text: CsvText, columns: Columns) -> CsvText:
    """Leave out the rows at the end whose drive cells are all blank; a RecordingWarning says how many."""
    places = [text.names.index(column.name) for column in columns.drive.values()]
    known = [
        number
        for number, row in enumerate(text.cells, start=1)
        if any(row[place].lower() not in NOT_MEASURED for place in places)
    ]
    left_out = len(text.cells) - known[-1] if known else 0
    if not left_out:
        return text
    warn(
        f"{text.path}: {left_out} frames after the drive's end were left out: what drove the body then is not known."
    )
    return replace(text, lines=text.lines[:-left_out], cells=text.cells[:-left_out])


TIME = "time_s"


def write_csv(recording: Recording, path: Path) -> None:
    """Write one run; a frame without an angle has a blank cell.

    A drive that switches between frames goes into a file of its own beside it, which the header names. A
    RecordingWarning says what is left out.
    """
    metadata = {key: value for key, value in recording.metadata.items() if key != DRIVE_KEY}
    names, columns = [TIME], [recording.time_s]
    if recording.drive_signal is not None:
        names += [channel.column for channel in recording.channels]
        columns += list(recording.drive_signal.T)
    if recording.markers is not None:
        names += marker_columns(recording.marker_names, recording.marker_unit)
        columns += list(recording.markers.reshape(len(recording.time_s), -1).T)
    if recording.drive_time_s is not None and recording.drive_values is not None:
        own = drive_path(path)
        metadata[DRIVE_KEY] = own.name
        drive_names = [TIME, *(channel.column for channel in recording.channels)]
        _write(own, {}, drive_names, [recording.drive_time_s, *recording.drive_values.T], recording.name)
    _write(path, metadata, [*names, SIN_THETA], [*columns, recording.sin_theta], recording.name)
    if recording.simulated_time_s is not None:
        warn(f"{path}: the simulated angle was left out, a CSV recording holds the measured one.")


def drive_path(path: Path) -> Path:
    """Return where the drive of a recording goes that switches between its frames."""
    return path.with_name(f"{path.stem}_drive{path.suffix}")


def _write(
    path: Path, metadata: Mapping[str, str], names: Sequence[str], columns: Sequence[np.ndarray], run: str
) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        for key, value in metadata.items():
            if "\n" in key + value or ":" in key:
                raise RecordingError(f"The header line {key!r} of {run} does not fit on one CSV line.")
            file.write(f"#{key}: {value}\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(names)
        writer.writerows([_digits(number) for number in row] for row in np.column_stack(columns).tolist())


def _digits(number: float) -> str:
    return "" if math.isnan(number) else repr(number).removesuffix(".0")
