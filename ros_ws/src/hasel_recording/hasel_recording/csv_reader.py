"""Read a lab's CSV file: `#key: value` lines, a row of column names, one row of numbers per frame."""

import warnings
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from hasel_recording.column_map import meant_names
from hasel_recording.csv_columns import Columns, understand
from hasel_recording.csv_numbers import CsvNumbers
from hasel_recording.csv_text import CsvText, read_text
from hasel_recording.drive_channel import HASEL_PAIR, DriveChannel
from hasel_recording.drive_end import until_drive_ends
from hasel_recording.errors import RecordingError, RecordingWarning
from hasel_recording.marker_angle import sin_theta_from_markers
from hasel_recording.recording import MARKER_NAMES, Recording
from hasel_recording.stand_in import as_meant

SEPARATED_BY = {";": "semicolons", "\t": "tabs", " ": "blanks"}


def read_csv(path: Path, mapping: Mapping[str, str] | None = None, own_drive: bool = True) -> Recording:
    """Read one run; raises RecordingError naming the line and column of what is wrong.

    mapping: {name that is known here: the file's own column}, as of column_map.parse_map. own_drive: False where the
    drive is in another file, to which some of the mapping belongs.
    """
    text = read_text(path)
    columns = understand(text.names, meant_names(mapping or {}, text.names, str(path), own_drive), str(path))
    for name in columns.unused:
        warnings.warn(
            f"{path}: column {name!r} is not used; --map says what a column is.",
            RecordingWarning,
            stacklevel=3,
        )
    text = until_drive_ends(text, columns)
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
        markers=markers,
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


def _markers(columns: Columns, numbers: CsvNumbers) -> np.ndarray | None:
    """Return the markers [n, m, 2]; NaN where one was not seen."""
    if not columns.markers:
        return None
    table = [numbers.column(column, may_be_missing=True) for column in columns.markers]
    return np.column_stack(table).reshape(len(table[0]), -1, 2)


def _angle(columns: Columns, numbers: CsvNumbers, markers: np.ndarray | None) -> np.ndarray:
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
