"""Recordings of a bench from files and folders, and the muscle that they are of."""

import contextlib
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path

from hasel_recording.errors import RecordingError, RecordingWarning
from hasel_sim.model.muscle_file import load_muscle
from hasel_sim.muscle.muscle import Muscle
from hasel_sysid.errors import SysidError

from hasel_muscle.read_csv import read_bench_csv
from hasel_muscle.read_mat import muscle_beside, read_bench_mat
from hasel_muscle.recording import BenchRecording
from hasel_muscle.settled import SettledRun, settled

_SUFFIXES = (".csv", ".mat")
_DEFAULT = "peano_hasel"


def read_bench(path: Path, mapping: Mapping[str, str] | None = None) -> BenchRecording:
    """One recording, .csv or .mat; mapping: columns of a .csv, as of --map. Raises RecordingError."""
    if not path.is_file():
        raise RecordingError(f"there is no recording {path}: check the name.")
    if path.suffix.lower() not in _SUFFIXES:
        raise RecordingError(f"{path}: a bench recording is a .csv or .mat file, not '{path.suffix}'.")
    return read_bench_mat(path) if path.suffix.lower() == ".mat" else read_bench_csv(path, mapping)


def readable(paths: Sequence[Path], mapping: Mapping[str, str] | None = None) -> list[BenchRecording]:
    """Those of the recordings that can be read."""
    found = []
    for path in paths:
        with contextlib.suppress(RecordingError):
            found.append(read_bench(path, mapping))
    return found


def settled_runs(
    paths: Sequence[Path], settling: float, mapping: Mapping[str, str] | None = None
) -> list[SettledRun]:
    """The settled frames of all recordings; one that cannot be used is told of and left out.

    Raises SysidError where none is left.
    """
    found = []
    for path in paths:
        try:
            found.append(settled(read_bench(path, mapping), settling))
        except (RecordingError, SysidError) as error:
            if len(paths) == 1:
                raise
            warnings.warn(f"left out: {error}", RecordingWarning, stacklevel=2)
    if not found:
        raise SysidError(
            "no recording can be used, for the reasons given; expected at least one with held lifts"
        )
    return found


def muscle_for(name: str | None, paths: Sequence[Path]) -> Muscle:
    """The muscle that was asked for, or the one described beside the recordings, or the package's own."""
    if name is not None:
        return load_muscle(name)
    described = next((muscle for path in paths if (muscle := muscle_beside(path)) is not None), None)
    if described is not None:
        return described
    warnings.warn(
        f"no --muscle was given: the package's own, '{_DEFAULT}', is taken; describe yours in a muscle file",
        RecordingWarning,
        stacklevel=2,
    )
    return load_muscle(_DEFAULT)
