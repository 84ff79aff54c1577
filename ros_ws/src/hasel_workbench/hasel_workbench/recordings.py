"""Recordings read for the workbench: what can be used, and what must be said of them."""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from hasel_recording import Recording, RecordingError, RecordingWarning, read_recording
from hasel_recording.csv_columns import understand
from hasel_recording.csv_text import TEXT_SUFFIXES, read_text
from hasel_recording.reading import distinct_names
from hasel_sim.model import Model
from hasel_sysid.data_gate import check_recording
from hasel_sysid.dataset import for_model, usable
from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import Experiment

from hasel_workbench.state import Banner, Unread


@dataclass(frozen=True)
class ReadingChoices:
    """How recordings are read. mapping: columns, as of --map; drives: the file of the drive of each recording, by the
    recording's path, for those that have one; own: columns of single files, by their paths, instead of `mapping`.
    """

    mapping: Mapping[str, str] = field(default_factory=dict)
    drives: Mapping[str, Path] = field(default_factory=dict)
    own: Mapping[str, Mapping[str, str]] = field(default_factory=dict)

    def of(self, path: str | Path) -> Mapping[str, str]:
        """The columns of one file."""
        return self.own.get(str(path), self.mapping)


def columns_of(path: str | Path) -> tuple[str, ...]:
    """Names of the columns of a file of rows where they are not understood; none of any other file."""
    path = Path(path)
    if path.suffix.lower() not in TEXT_SUFFIXES:
        return ()
    try:
        names = read_text(path).names
    except (RecordingError, OSError):
        return ()
    try:
        understand(names, {}, str(path))
    except RecordingError:
        return tuple(names)
    return ()


def read(
    paths: Sequence[str | Path], reading: ReadingChoices, unseen: bool = False
) -> tuple[list[Recording], list[Banner], list[Unread]]:
    """What can be read, a sentence for each that cannot, and those of them that have columns to choose from."""
    found, banners, unread = [], [], []
    for path in paths:
        try:
            found.append(read_recording(path, reading.of(path) or None, reading.drives.get(str(path))))
        except RecordingError as error:
            banners.append(Banner("error", str(error)))
            names = columns_of(path)
            if names:
                unread.append(Unread(Path(path), names, unseen))
    return found, banners, unread


def checked(
    model: Model, recordings: Sequence[Recording], known: Sequence[Experiment]
) -> tuple[list[Experiment], list[Banner]]:
    """Those that this model can be compared with, and what the data check finds in them.

    known: what is loaded already; no file is loaded twice, and files of one name get names that differ.
    """
    found: list[Experiment] = []
    banners: list[Banner] = []
    for recording in recordings:
        others = [*known, *found]
        same = [each for each in others if each.name == recording.name]
        if (
            same
            and recording.path is not None
            and all(e.recording.path not in (None, recording.path) for e in same)
        ):
            paths = [each.recording.path for each in others if each.recording.path is not None]
            recording = replace(recording, name=distinct_names([*paths, recording.path])[-1])
        elif same:
            banners.append(Banner("warning", f"{recording.name} is loaded already."))
            continue
        try:
            with warnings.catch_warnings(record=True) as said:
                warnings.simplefilter("always", RecordingWarning)
                (experiment,) = for_model(model.with_levels([]), usable([recording]))
        except (RecordingError, SysidError) as error:
            banners.append(Banner("error", str(error)))
            continue
        found.append(experiment)
        banners += [Banner("warning", str(each.message)) for each in said]
        banners += [Banner(f.severity.value, str(f)) for f in check_recording(experiment.recording)]
    return found, banners
