"""A drive recorded as a file of its own: rows of time and channels, each holding until the next."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from hasel_recording.bag import read_bag
from hasel_recording.column_map import meant_names
from hasel_recording.csv_columns import understand
from hasel_recording.csv_numbers import CsvNumbers
from hasel_recording.csv_reader import drive_columns
from hasel_recording.csv_text import TEXT_SUFFIXES, read_text
from hasel_recording.drive_channel import DriveChannel
from hasel_recording.errors import RecordingError, RecordingWarning
from hasel_recording.mcap_drive import stamped_drive
from hasel_recording.mcap_reader import seconds, time_origin
from hasel_recording.recording import Recording
from hasel_recording.stand_in import as_meant
from hasel_recording.zero_order_hold import held, row_in_force


@dataclass(frozen=True)
class RecordedDrive:
    """Values [k, channels] in SI units, each from its time_s [k] to the next. start_ns: time 0 since the epoch [ns], if
    it is known. stand_in: a sentence where voltages stand for another quantity, or ''."""

    channels: tuple[DriveChannel, ...]
    time_s: np.ndarray
    values: np.ndarray
    start_ns: int | None = None
    stand_in: str = ""


def read_drive(
    path: Path, mapping: Mapping[str, str] | None = None, metadata: Mapping[str, str] | None = None
) -> RecordedDrive:
    """Read the drive alone of a .csv or .mcap file or a bag; raises RecordingError.

    mapping: as of column_map.parse_map; metadata: header lines of the run, which those of the file go before.
    """
    if not path.exists():
        raise RecordingError(f"There is no drive file {path}: check the name.")
    read = _read_csv if path.suffix.lower() in TEXT_SUFFIXES else _read_bag
    return read(path, mapping or {}, metadata or {})


def with_drive(recording: Recording, path: Path, mapping: Mapping[str, str] | None = None) -> Recording:
    """Return the recording with the drive of another file in place of its own.

    path: a .csv file with time and drive columns, or an .mcap file or bag with the drive's topic, counting time as the
    recording does. mapping: as of column_map.parse_map; pairs for columns that this file has not got are passed over.
    A RecordingWarning says where the drive does not reach over the whole run; raises RecordingError where it does not
    overlap with it at all.
    """
    if not path.exists():
        raise RecordingError(f"{recording.name}: there is no drive file {path}: check the name.")
    drive = read_drive(path, mapping, recording.metadata)
    channels, time_s, values = drive.channels, drive.time_s, drive.values
    _check_cover(recording, path, channels, time_s, values)
    started = max(
        0, int(row_in_force(time_s, recording.time_s[0]))
    )  # what was before the run matters only if the body was driven then
    first = started if not values[: started + 1].any() else 0
    said = f"the drive comes from {path.name}: {', '.join(map(str, channels))}"
    return replace(
        recording,
        channels=channels,
        drive_signal=held(time_s, values, recording.time_s),
        drive_time_s=time_s[first:],
        drive_values=values[first:],
        understood=(*recording.understood, *filter(None, [said, drive.stand_in])),
    )


def _read_csv(path: Path, mapping: Mapping[str, str], metadata: Mapping[str, str]) -> RecordedDrive:
    text = read_text(path)
    text = replace(text, metadata={**metadata, **text.metadata})
    meant = meant_names(mapping, text.names, str(path), all_here=False, of_drive=True)
    columns = understand(text.names, meant, str(path), angle=False)
    numbers = CsvNumbers(text)
    time_s = numbers.times(columns.time)
    channels, values, stand_in = drive_columns(columns, numbers, text)
    if values is None:
        raise RecordingError(
            f"{path} has no drive, only {', '.join(text.names)}: expected columns such as voltage_upper_v or "
            "pressure_chamber_kpa, or say which they are with --map."
        )
    return RecordedDrive(channels, time_s, values, stand_in=stand_in)


def _read_bag(path: Path, mapping: Mapping[str, str], metadata: Mapping[str, str]) -> RecordedDrive:
    file = read_bag(path)
    drive = stamped_drive(file)
    if drive is None:
        raise RecordingError(f"{path} has neither /hasel/state nor /hasel/drive: give the drive's recording.")
    channels, values, stand_in = as_meant(drive.channels, drive.values, metadata, str(path))
    origin = time_origin(file, drive.stamps)
    return RecordedDrive(channels, seconds(drive.stamps, origin), values, origin or None, stand_in)


def _check_cover(
    recording: Recording,
    path: Path,
    channels: tuple[DriveChannel, ...],
    time_s: np.ndarray,
    values: np.ndarray,
) -> None:
    first, last = recording.time_s[[0, -1]]
    if time_s[0] > last:
        raise RecordingError(
            f"{recording.name}: the drive in {path} begins at {time_s[0]:g} s, when the recording has ended "
            f"({last:g} s): give both the same time."
        )
    if time_s[0] > first:
        _warn(recording, f"the drive in {path} begins at {time_s[0]:g} s; before, nothing is taken to drive")
    steps = np.diff(time_s)
    pause = max(steps.max(initial=0.0), 1.0)
    if values[-1].any() and last - time_s[-1] > 2 * pause:
        held = ", ".join(
            channel.shown(value) for channel, value in zip(channels, values[-1], strict=True) if value
        )
        _warn(
            recording,
            f"the drive in {path} ends at {time_s[-1]:g} s with {held}, which is taken to hold until {last:g} s",
        )


def _warn(recording: Recording, sentence: str) -> None:
    warnings.warn(f"{recording.name}: {sentence}.", RecordingWarning, stacklevel=4)
