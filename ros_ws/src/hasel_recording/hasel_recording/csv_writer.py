"""Write a run as CSV with the shortest digits that give back the same numbers."""

import csv
import warnings
from pathlib import Path

import numpy as np

from hasel_recording.csv_columns import SIN_THETA, TIME, VOLTAGES, marker_columns
from hasel_recording.errors import RecordingError, RecordingWarning
from hasel_recording.recording import Recording


def write_csv(recording: Recording, path: Path) -> None:
    """Write one run; a RecordingWarning says what a CSV file cannot hold (lost frames, exact switching)."""
    _warn_of_losses(recording, path)
    names, columns = [TIME], [recording.time_s]
    if recording.voltage is not None:
        names += VOLTAGES
        columns += list(recording.voltage.T)
    if recording.markers is not None:
        names += marker_columns(recording.marker_unit)
        columns += list(recording.markers.reshape(len(recording.time_s), 6).T)
    names.append(SIN_THETA)
    columns.append(recording.sin_theta)
    with path.open("w", encoding="utf-8", newline="") as file:
        for key, value in recording.metadata.items():
            if "\n" in key + value or ":" in key:
                raise RecordingError(
                    f"The header line {key!r} of {recording.name} does not fit on one CSV line."
                )
            file.write(f"#{key}: {value}\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(names)
        rows = np.column_stack(columns)[recording.valid]
        writer.writerows([_digits(number) for number in row] for row in rows.tolist())


def _digits(number: float) -> str:
    return repr(number).removesuffix(".0")


def _warn_of_losses(recording: Recording, path: Path) -> None:
    lost = len(recording.time_s) - int(recording.valid.sum())
    if lost:
        warnings.warn(
            f"{path}: {lost} frames without an angle were left out, a CSV recording cannot hold them.",
            RecordingWarning,
            stacklevel=3,
        )
    if recording.drive_time_s is not None:
        warnings.warn(
            f"{path}: the voltage switches between frames; in CSV each switch moves to the next frame.",
            RecordingWarning,
            stacklevel=3,
        )
    if recording.simulated_time_s is not None:
        warnings.warn(
            f"{path}: the simulated angle was left out, a CSV recording holds the measured one.",
            RecordingWarning,
            stacklevel=3,
        )
