"""Turn a recording of one kind into the other, without losing a digit."""

from collections.abc import Mapping
from pathlib import Path

from hasel_recording.csv_text import TEXT_SUFFIXES
from hasel_recording.csv_writer import drive_path
from hasel_recording.errors import RecordingError
from hasel_recording.reading import WRITERS, read_recording, write_recording

OTHER_SUFFIX = dict.fromkeys(TEXT_SUFFIXES, ".mcap") | {".mcap": ".csv", ".db3": ".csv"}


def target_path(source: Path, output: Path | None = None) -> Path:
    """Return where a conversion goes: `output` when it is a file name, else the source's name in that folder.

    Without output the new file lies beside the source.
    """
    if output is not None and output.suffix.lower() in WRITERS:
        return output
    suffix = OTHER_SUFFIX.get(source.suffix.lower(), ".csv")  # a rosbag2 folder has no suffix
    folder = source.parent if output is None else output
    return folder / (source.stem + suffix)


def convert(
    source: Path,
    output: Path | None = None,
    *,
    replace: bool = False,
    mapping: Mapping[str, str] | None = None,
    drive: str | Path | None = None,
) -> Path:
    """Convert CSV to MCAP or MCAP to CSV and return the new file; raises RecordingError.

    An existing file is replaced only when `replace` is set. mapping, drive: as of read_recording.
    """
    recording = read_recording(source, mapping, drive)
    target = target_path(source, output)
    written = [target]
    if target.suffix.lower() == ".csv" and recording.drive_time_s is not None:
        written.append(drive_path(target))
    for path in written:
        if path.exists() and not replace:
            raise RecordingError(f"{path} exists already: give --force to replace it, or another --output.")
    target.parent.mkdir(parents=True, exist_ok=True)
    write_recording(recording, target)
    return target
