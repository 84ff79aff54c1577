"""Write a run as CSV with the shortest digits that give back the same numbers."""

import csv
import math
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from hasel_recording.csv_columns import SIN_THETA, marker_columns
from hasel_recording.errors import RecordingError, RecordingWarning
from hasel_recording.recording import DRIVE_KEY, Recording

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
    if recording.drive_time_s is not None:
        own = drive_path(path)
        metadata[DRIVE_KEY] = own.name
        drive_names = [TIME, *(channel.column for channel in recording.channels)]
        _write(own, {}, drive_names, [recording.drive_time_s, *recording.drive_values.T], recording.name)
    _write(path, metadata, [*names, SIN_THETA], [*columns, recording.sin_theta], recording.name)
    if recording.simulated_time_s is not None:
        warnings.warn(
            f"{path}: the simulated angle was left out, a CSV recording holds the measured one.",
            RecordingWarning,
            stacklevel=2,
        )


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
