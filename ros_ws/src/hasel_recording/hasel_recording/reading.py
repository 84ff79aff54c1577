"""Read and write recordings of either kind."""

import warnings
from collections.abc import Iterable
from pathlib import Path

from hasel_recording.csv_reader import read_csv
from hasel_recording.csv_writer import write_csv
from hasel_recording.errors import RecordingError, RecordingWarning, nearest
from hasel_recording.mcap_reader import read_mcap
from hasel_recording.mcap_writer import write_mcap
from hasel_recording.recording import Recording

READERS = {".csv": read_csv, ".mcap": read_mcap}
WRITERS = {".csv": write_csv, ".mcap": write_mcap}


def read_recording(path: str | Path) -> Recording:
    """Read a `.csv` or `.mcap` file, or the folder that `ros2 bag record` made; raises RecordingError."""
    path = Path(path)
    if path.is_dir():
        path = _only_mcap(path)
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise RecordingError(f"{path} is not a recording: give a .mcap or a .csv file.")
    if not path.is_file():
        folder = path.parent
        near = nearest(path.name, [p.name for p in folder.iterdir()]) if folder.is_dir() else None
        hint = f"did you mean {folder / near}?" if near else "check the name."
        raise RecordingError(f"There is no file {path}: {hint}")
    try:
        return reader(path)
    except OSError as error:
        raise RecordingError(f"{path} cannot be read ({error.strerror}): check its permissions.") from None


def read_recordings(paths: Iterable[str | Path]) -> list[Recording]:
    """Read all that can be read; the others are skipped, each with a RecordingWarning.

    Raises RecordingError when none can be read.
    """
    recordings, errors = [], []
    for path in paths:
        try:
            recordings.append(read_recording(path))
        except RecordingError as error:
            errors.append(str(error))
    if not recordings:
        raise RecordingError(
            " ".join(errors) or "No recording was given: name at least one .mcap or .csv file."
        )
    for error in errors:
        warnings.warn(f"Skipped: {error}", RecordingWarning, stacklevel=2)
    return recordings


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


def _only_mcap(folder: Path) -> Path:
    files = sorted(folder.glob("*.mcap"))
    if len(files) != 1:
        raise RecordingError(f"Folder {folder} holds {len(files)} MCAP files: name the one to read.")
    return files[0]
