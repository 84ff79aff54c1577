# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A path in, recordings out, and back: of either kind, with the drive as a file of its own."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from hasel_common.names import nearest

from hasel_recording.bag import read_bag
from hasel_recording.csv_columns import as_mapping, meant_names, understand
from hasel_recording.csv_numbers import CsvNumbers
from hasel_recording.csv_run import drive_columns, read_csv, write_csv
from hasel_recording.csv_text import TEXT_SUFFIXES, read_text
from hasel_recording.drive_channel import DriveChannel, as_meant
from hasel_recording.errors import RecordingError, warn
from hasel_recording.mcap_run import read_mcap, seconds, stamped_drive, time_origin, write_mcap
from hasel_recording.recording import DRIVE_KEY, Recording, held, row_in_force
from hasel_recording.switch_times import with_placed_switches


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

    mapping: as of csv_columns.parse_map; metadata: header lines of the run, which those of the file go before.
    """
    if not path.exists():
        raise RecordingError(f"There is no drive file {path}: check the name.")
    if path.suffix.lower() not in TEXT_SUFFIXES:
        file = read_bag(path)
        drive = stamped_drive(file)
        if drive is None:
            raise RecordingError(
                f"{path} has neither /hasel/state nor /hasel/drive: give the drive's recording."
            )
        channels, values, stand_in = as_meant(drive.channels, drive.values, metadata or {}, str(path))
        origin = time_origin(file, drive.stamps)
        return RecordedDrive(channels, seconds(drive.stamps, origin), values, origin or None, stand_in)
    text = read_text(path)
    text = replace(text, metadata={**(metadata or {}), **text.metadata})
    meant = meant_names(mapping or {}, text.names, str(path), all_here=False, of_drive=True)
    columns, numbers = understand(text.names, meant, str(path), angle=False), CsvNumbers(text)
    time_s = numbers.times(columns.time)
    channels, values, stand_in = drive_columns(columns, numbers, text)
    if values is None:
        raise RecordingError(
            f"{path} has no drive, only {', '.join(text.names)}: expected columns such as voltage_upper_v or "
            "pressure_chamber_kpa, or say which they are with --map."
        )
    return RecordedDrive(channels, time_s, values, stand_in=stand_in)


def with_drive(recording: Recording, path: Path, mapping: Mapping[str, str] | None = None) -> Recording:
    """Return the recording with the drive of another file in place of its own.

    path: a .csv file with time and drive columns, or an .mcap file or bag with the drive's topic, counting time as the
    recording does. mapping: as of csv_columns.parse_map; pairs for columns that this file has not got are passed over.
    A RecordingWarning says where the drive does not reach over the whole run; raises RecordingError where it does not
    overlap with it at all.
    """
    if not path.exists():
        raise RecordingError(f"{recording.name}: there is no drive file {path}: check the name.")
    drive = read_drive(path, mapping, recording.metadata)
    _check_cover(recording, path, drive)
    started = max(0, int(row_in_force(drive.time_s, recording.time_s[0])))
    first = 0 if drive.values[: started + 1].any() else started  # before the run it matters only if it drove
    said = f"the drive comes from {path.name}: {', '.join(map(str, drive.channels))}"
    return replace(
        recording,
        channels=drive.channels,
        drive_signal=held(drive.time_s, drive.values, recording.time_s),
        drive_time_s=drive.time_s[first:],
        drive_values=drive.values[first:],
        understood=(*recording.understood, *filter(None, [said, drive.stand_in])),
    )


def _check_cover(recording: Recording, path: Path, drive: RecordedDrive) -> None:
    (first, last), (begin, end) = recording.time_s[[0, -1]], drive.time_s[[0, -1]]
    if begin > last:
        raise RecordingError(
            f"{recording.name}: the drive in {path} begins at {begin:g} s, when the recording has ended "
            f"({last:g} s): give both the same time."
        )
    if begin > first:
        warn(
            f"{recording.name}: the drive in {path} begins at {begin:g} s; before, nothing is taken to drive."
        )
    pause = max(np.diff(drive.time_s).max(initial=0.0), 1.0)
    if drive.values[-1].any() and last - end > 2 * pause:
        pairs = zip(drive.channels, drive.values[-1], strict=True)
        on = ", ".join(channel.shown(value) for channel, value in pairs if value)
        warn(
            f"{recording.name}: the drive in {path} ends at {end:g} s with {on}, which is taken to hold until "
            f"{last:g} s."
        )


SUFFIXES = (*TEXT_SUFFIXES, ".mcap", ".db3")
WRITERS = {".csv": write_csv, ".mcap": write_mcap}


def read_recording(
    path: str | Path, mapping: Mapping[str, str] | str | None = None, drive: str | Path | None = None
) -> Recording:
    """Read a `.csv`, `.mcap` or `.db3` file, or the folder that `ros2 bag record` made; raises RecordingError.

    mapping: {name that is known here: the file's own column} for CSV files, or the text of csv_columns.parse_map.
    drive: the file that holds the drive, instead of what the recording or its header line `drive` says.
    """
    path, mapping = Path(path), as_mapping(mapping)
    if path.suffix.lower() not in SUFFIXES and not path.is_dir():
        raise RecordingError(
            f"{path} is not a recording: give a .mcap, .db3 or .csv file, or a bag's folder."
        )
    if not path.exists():
        folder = path.parent
        near = nearest(path.name, [p.name for p in folder.iterdir()]) if folder.is_dir() else None
        hint = f"did you mean {folder / near}?" if near else "check the name."
        raise RecordingError(f"There is no file {path}: {hint}")
    try:
        return _read(path, mapping, None if drive is None else Path(drive))
    except AttributeError as error:  # messages are made from the definition in the file
        raise RecordingError(
            f"{path} defines messages without {error.name!r}: its definitions are damaged or of another kind; restore "
            "it from a copy, or record it with ROS 2 Jazzy."
        ) from None
    except OSError as error:
        raise RecordingError(f"{path} cannot be read ({error.strerror}): check its permissions.") from None


def _read(path: Path, mapping: Mapping[str, str], drive: Path | None) -> Recording:
    in_rows = path.suffix.lower() in TEXT_SUFFIXES
    recording = read_csv(path, mapping, drive is None) if in_rows else read_mcap(path)
    if drive is None and DRIVE_KEY in recording.metadata:
        drive = path.parent / recording.metadata[DRIVE_KEY]
        others = {key: value for key, value in recording.metadata.items() if key != DRIVE_KEY}
        recording = replace(recording, metadata=others)
    if drive is not None:
        return with_drive(recording, drive, mapping)
    return with_placed_switches(recording) if in_rows else recording


def read_recordings(
    paths: Iterable[str | Path],
    mapping: Mapping[str, str] | str | None = None,
    drives: Sequence[str | Path | None] | None = None,
    names: Sequence[str] | None = None,
) -> list[Recording]:
    """Read all that can be read; the others are skipped, each with a RecordingWarning.

    mapping: as of read_recording. drives: one file per recording, or one for all of them. names: of the runs (default:
    as of distinct_names). Raises RecordingError when none can be read.
    """
    recordings, errors = [], []
    paths, mapping = list(paths), as_mapping(mapping)
    names = names or distinct_names(paths)
    for path, drive, name in zip(paths, drive_of_each(paths, drives), names, strict=True):
        try:
            recordings.append(replace(read_recording(path, mapping, drive), name=name))
        except RecordingError as error:
            errors.append(str(error))
    if not recordings:
        raise RecordingError(
            " ".join(errors) or "No recording was given: name at least one .mcap or .csv file."
        )
    for error in errors:
        warn(f"Skipped: {error}")
    return recordings


def distinct_names(paths: Sequence[str | Path]) -> list[str]:
    """The shortest names that differ: the file's without its suffix, after as many folders as it takes (monday_run).

    Files of one folder that differ in their suffix keep it; a file that is given several times is numbered.
    """
    places = [Path(path).absolute() for path in paths]
    labels = {place: _label(place, 1) for place in places}
    for shared in {label for label in labels.values() if list(labels.values()).count(label) > 1}:
        alike = [place for place, label in labels.items() if label == shared]
        for depth in range(2, max(len(place.parts) for place in alike)):
            longer = {place: _label(place, depth) for place in alike}
            if len(set(longer.values())) == len(alike):
                break
        else:
            longer = {place: place.name for place in alike}
        labels |= longer
    names = [labels[place] for place in places]
    return [
        f"{name}_{names[:number].count(name) + 1}" if name in names[:number] else name
        for number, name in enumerate(names)
    ]


def _label(place: Path, depth: int) -> str:
    return "_".join([*place.parts[-depth:-1], place.name if place.is_dir() else place.stem])


def drive_of_each(
    paths: Sequence[str | Path], drives: Sequence[str | Path | None] | None
) -> Sequence[str | Path | None]:
    """Return the drive file of each recording, None where it has its own; raises RecordingError for a wrong number."""
    if not drives:
        return [None] * len(paths)
    if len(drives) not in (1, len(paths)):
        raise RecordingError(
            f"{len(drives)} drive files were given for {len(paths)} recordings: give one for each, one for all, "
            "or name each in its recording's header (#drive: FILE)."
        )
    return drives if len(drives) == len(paths) else list(drives) * len(paths)


def write_recording(recording: Recording, path: str | Path) -> None:
    """Write a `.csv` or `.mcap` file, replacing one that exists; raises RecordingError."""
    path = Path(path)
    writer = WRITERS.get(path.suffix.lower())
    if writer is None:
        raise RecordingError(f"{path} says neither MCAP nor CSV: end its name in .mcap or .csv.")
    try:
        writer(recording, path)
    except OSError as error:
        raise RecordingError(f"{path} cannot be written ({error.strerror}): choose another place.") from None
