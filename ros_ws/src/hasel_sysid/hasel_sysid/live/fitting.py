"""The fit and the diagnosis that the node's services ask for."""

from collections.abc import Sequence
from pathlib import Path

from hasel_common.progress import Workload
from hasel_recording import Recording, read_recordings
from hasel_sim.model import Model
from hasel_sim.parallel import executor

from hasel_sysid.candidates import effects_of
from hasel_sysid.dataset import for_model, prepared, simulable, usable
from hasel_sysid.diagnosis import Diagnosis, Verdict
from hasel_sysid.estimation import FittedModel, fit_baseline, identify
from hasel_sysid.expected_work import plan_of_diagnosis, plan_of_fit
from hasel_sysid.experiment import GENTLEST
from hasel_sysid.improvement import diagnose
from hasel_sysid.policy import POLICY
from hasel_sysid.problem import Problem
from hasel_sysid.result import Status
from hasel_sysid.verdict import status_with

DEFAULT_METHOD = "least_squares"


def chosen_recordings(paths: Sequence[str | Path], heard: Sequence[Recording]) -> list[Recording]:
    """The named recordings, or what was heard when none is named. Raises RecordingError."""
    return read_recordings(paths) if paths else list(heard)


def fit_recordings(
    model: Model, recordings: Sequence[Recording], method: str, jobs: int, workload: Workload
) -> FittedModel:
    """Fit the model's free parameters in `jobs` processes (0: one per core), this one staying responsive.

    workload: counts the simulations. Raises RecordingError, SysidError, SimulationError or ModelError.
    """
    experiments = for_model(model.with_levels([]), usable(recordings))
    with executor(jobs or None) as pool:
        start = prepared(model, experiments)
        problem = Problem(simulable(start, experiments, pool, GENTLEST), pool, workload=workload)
        workload.expect(plan_of_fit(problem.work(start)))
        return identify(problem, start, method or DEFAULT_METHOD)


def diagnose_recordings(
    model: Model,
    recordings: Sequence[Recording],
    effects: Sequence[str],
    jobs: int,
    workload: Workload,
) -> Diagnosis:
    """Fit and rank the effects (all known ones when none is named) that could be missing.

    workload: counts the simulations. Raises RecordingError, SysidError, SimulationError or ModelError.
    """
    experiments = for_model(model.with_levels([]), usable(recordings))
    with executor(jobs or None) as pool:
        start = prepared(model, experiments)
        problem = Problem(simulable(start, experiments, pool, GENTLEST), pool, workload=workload)
        workload.expect(plan_of_diagnosis(problem.work(start), len(effects_of(start, effects or None))))
        fit = fit_baseline(problem, start)
        return diagnose(problem, fit, effects or None)


def status(diagnosis: Diagnosis) -> str:
    """What a diagnosis comes to, before any effect is added: one of the words of the Diagnosis message."""
    describes = diagnosis.goodness is not None and diagnosis.goodness.adequate
    if diagnosis.p_value >= POLICY.level:
        return (Status.NOTHING_MISSING if describes else Status.UNEXPLAINED).value
    missing = any(finding.verdict is Verdict.MISSING for finding in diagnosis.findings)
    left = 1.0 - diagnosis.explained
    return (status_with(left, describes) if missing else Status.UNEXPLAINED).value
