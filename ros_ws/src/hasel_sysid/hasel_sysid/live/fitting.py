"""The fit that the node's service asks for."""

from collections.abc import Sequence
from pathlib import Path

from hasel_recording import Recording, read_recordings
from hasel_sim.errors import nearest_name
from hasel_sim.model import Model
from hasel_sim.parallel import executor

from hasel_sysid.dataset import experiment, prepared
from hasel_sysid.errors import SysidError
from hasel_sysid.fit import METHODS, FitResult
from hasel_sysid.fit.least_squares import Progress
from hasel_sysid.problem import Problem

DEFAULT_METHOD = "least_squares"


def chosen_recordings(paths: Sequence[str | Path], heard: Sequence[Recording]) -> list[Recording]:
    """The named recordings, or what was heard when none is named. Raises RecordingError."""
    return read_recordings(paths) if paths else list(heard)


def fit_recordings(
    model: Model, recordings: Sequence[Recording], method: str, jobs: int, progress: Progress | None = None
) -> FitResult:
    """Fit the model's free parameters in `jobs` processes (0: one per core), this one staying responsive.

    Raises SysidError, SimulationError or ModelError.
    """
    method = method or DEFAULT_METHOD
    if method not in METHODS:
        raise SysidError(f"unknown method '{method}'; {nearest_name(method, METHODS)}")
    experiments = [experiment(recording) for recording in recordings]
    with executor(jobs or None) as pool:
        return METHODS[method](Problem(experiments, pool), prepared(model, experiments), progress)
