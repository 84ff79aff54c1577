# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Recordings read for the workbench: what can be used, and what must be said of them."""

import warnings
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

from hasel_recording import Recording, RecordingError, RecordingWarning, read_recording
from hasel_recording.csv_columns import meant_names, understand
from hasel_recording.csv_text import TEXT_SUFFIXES, read_text
from hasel_recording.reading import distinct_names
from hasel_sim.model import Model
from hasel_sysid.data_quality import check_recording
from hasel_sysid.dataset import for_model, usable
from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import Experiment

from hasel_workbench.state import Banner, Unread

_NEEDED = (
    "It cannot be read so: expected a time and an angle, or the markers head, middle and tail, each column once; "
    "choose again."
)


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


def place_of(recording: Recording) -> str:
    """That of its file; of one that is in no file, its name."""
    return recording.name if recording.path is None else file_place(recording.path)


def file_place(path: str | Path) -> str:
    """Where a file is, however its path is written."""
    return str(Path(path).resolve())


def columns_of(path: str | Path) -> tuple[str, ...]:
    """Names of the columns of a file of rows where they are not understood; none of any other file."""
    path = Path(path)
    if path.suffix.lower() in TEXT_SUFFIXES:
        with suppress(RecordingError, OSError):
            names = read_text(path).names
            return () if _are_understood(names, {}) else tuple(names)
    return ()


def _are_understood(names: Sequence[str], mapping: Mapping[str, str]) -> bool:
    with suppress(RecordingError):
        understand(list(names), meant_names(mapping, names, "", all_here=False), "")
        return True
    return False


def read(
    paths: Sequence[str | Path], reading: ReadingChoices, unseen: bool = False
) -> tuple[list[Recording], list[Banner], list[Unread]]:
    """What can be read, those of the others that have columns to choose from, and a sentence for each that has not."""
    found, banners, unread = [], [], []
    for path in paths:
        try:
            found.append(read_recording(path, reading.of(path) or None, reading.drives.get(str(path))))
        except RecordingError as error:
            said = str(error).replace(str(path), Path(path).name)
            names = columns_of(path)
            if not names:
                banners.append(Banner("error", said, file_place(path)))
                continue
            if not _are_understood(names, reading.of(path)):
                said = _NEEDED if str(path) in reading.own else ""
            unread.append(Unread(Path(path), names, unseen, said))
    return found, banners, unread


def checked(
    model: Model, recordings: Sequence[Recording], known: Sequence[Experiment]
) -> tuple[list[Experiment], list[Experiment], list[Banner]]:
    """Those known already, those of the others that this model can be compared with, and what is to be said of these.

    No file is loaded twice, and files of one name get names that differ, as the commands name them.
    """
    places = {place_of(each.recording) for each in known}
    new: dict[str, Recording] = {}
    found: list[Experiment] = []
    banners: list[Banner] = []
    for recording in recordings:
        place = place_of(recording)
        if place in places or place in new:
            banners.append(Banner("warning", f"{recording.name} is loaded already.", place))
        else:
            new[place] = recording
    names = _names([*(each.recording for each in known), *new.values()])
    for (place, recording), name in zip(new.items(), names[len(known) :], strict=True):
        try:
            with warnings.catch_warnings(record=True) as said:
                warnings.simplefilter("always", RecordingWarning)
                (experiment,) = for_model(model.with_levels([]), usable([replace(recording, name=name)]))
        except (RecordingError, SysidError) as error:
            banners.append(Banner("error", str(error), place))
            continue
        found.append(experiment)
        banners += [Banner("warning", str(each.message), place) for each in said]
        banners += [Banner(f.severity.value, str(f), place) for f in check_recording(experiment.recording)]
    renamed = [
        Experiment(replace(each.recording, name=name), replace(each.run, name=name))
        for each, name in zip(known, names, strict=False)
    ]
    return renamed, found, banners


def _names(recordings: Sequence[Recording]) -> list[str]:
    """Names that differ; one that is in no file keeps its own."""
    names = iter(distinct_names([each.path for each in recordings if each.path is not None]))
    return [each.name if each.path is None else next(names) for each in recordings]
