"""Read a lab's CSV file: `#key: value` lines, a row of column names, one row of numbers per frame."""

import csv
import math
import warnings
from pathlib import Path
from typing import TextIO

import numpy as np

from hasel_recording.csv_columns import KNOWN, SIN_THETA, TIME, VOLTAGES, check_columns, marker_columns
from hasel_recording.errors import RecordingError, RecordingWarning
from hasel_recording.marker_angle import sin_theta_from_markers
from hasel_recording.recording import Recording


def read_csv(path: Path) -> Recording:
    """Read one run; raises RecordingError naming the line and column of what is wrong."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            metadata, names, line = _read_top(file, path)
            lines, values = _read_rows(file, path, names, line)
    except UnicodeDecodeError:
        raise RecordingError(f"{path} is not a text file: give a CSV or an MCAP recording.") from None
    table = {name: column for name, column in zip(names, values.T, strict=True) if name in KNOWN}
    _check_numbers(table, lines, path)
    markers, unit = _markers(table)
    return Recording(
        name=path.stem,
        path=path,
        metadata=metadata,
        time_s=table[TIME],
        drive_signal=np.column_stack([table[name] for name in VOLTAGES]) if VOLTAGES[0] in table else None,
        sin_theta=table[SIN_THETA] if SIN_THETA in table else _angle(markers, unit, lines, path),
        markers=markers,
        marker_unit=unit,
    )


def _read_top(file: TextIO, path: Path) -> tuple[dict[str, str], list[str], int]:
    """Return the header lines, the column names and the number of the line that holds them."""
    metadata: dict[str, str] = {}
    for number, line in enumerate(file, start=1):
        text = line.strip()
        if text.startswith("#"):
            key, colon, value = text[1:].partition(":")
            if colon:
                metadata[key.strip()] = value.strip()
        elif text:
            names = [name.strip() for name in next(csv.reader([text]))]
            check_columns(names, str(path))
            for name in names:
                if name not in KNOWN:
                    warnings.warn(f"{path}: column {name!r} is not used.", RecordingWarning, stacklevel=4)
            return metadata, names, number
    raise RecordingError(f"{path} is empty: give a file with a row of column names and a row per frame.")


def _read_rows(file: TextIO, path: Path, names: list[str], start: int) -> tuple[list[int], np.ndarray]:
    """Return the line numbers [n] and the numbers [n, columns] of all rows."""
    reader = csv.reader(file)
    lines, rows = [], []
    for cells in reader:
        line = start + reader.line_num
        if not cells:
            continue
        if len(cells) != len(names):
            raise RecordingError(
                f"{path}, line {line} has {len(cells)} cells where the top row names {len(names)} columns: "
                "repair or remove the line."
            )
        rows.append([_number(cell, name, path, line) for cell, name in zip(cells, names, strict=True)])
        lines.append(line)
    if not rows:
        raise RecordingError(f"{path} has column names but no frames: was the recording stopped too early?")
    return lines, np.array(rows)


def _number(cell: str, name: str, path: Path, line: int) -> float:
    if name not in KNOWN:
        return math.nan
    try:
        value = float(cell)
    except ValueError:
        raise RecordingError(
            f"{path}, line {line}: {cell!r} in column {name} is not a number; repair or remove the line."
        ) from None
    if not math.isfinite(value):
        raise RecordingError(
            f"{path}, line {line}: {name} is {cell.strip()}, but a number is expected; remove the line."
        )
    return value


def _check_numbers(table: dict[str, np.ndarray], lines: list[int], path: Path) -> None:
    times = table[TIME]
    late = np.flatnonzero(np.diff(times) <= 0)
    if late.size:
        row = late[0] + 1
        raise RecordingError(
            f"{path}, line {lines[row]}: time_s {times[row]:g} does not come after {times[row - 1]:g}; "
            "sort the rows by time and remove doubles."
        )


def _markers(table: dict[str, np.ndarray]) -> tuple[np.ndarray | None, str]:
    """Return the markers [n, 3, 2], metres before pixels, and their unit."""
    for unit in ("m", "px"):
        columns = marker_columns(unit)
        if columns[0] in table:
            return np.column_stack([table[name] for name in columns]).reshape(-1, 3, 2), unit
    return None, "m"


def _angle(markers: np.ndarray, unit: str, lines: list[int], path: Path) -> np.ndarray:
    upward = markers * (1, -1) if unit == "px" else markers
    sin_theta = sin_theta_from_markers(upward)
    lost = np.flatnonzero(np.isnan(sin_theta))
    if lost.size:
        raise RecordingError(
            f"{path}, line {lines[lost[0]]}: two markers coincide, so there is no angle; remove the line."
        )
    return sin_theta
