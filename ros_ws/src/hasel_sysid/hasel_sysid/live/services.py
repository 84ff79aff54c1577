# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The fit and the diagnosis that the node's services ask for, and all results as ROS messages."""

import math
from collections.abc import Collection, Sequence
from concurrent.futures import Executor
from pathlib import Path

from hasel_common.progress import Workload
from hasel_interfaces import msg
from hasel_recording import Recording, read_recordings
from hasel_sim.live.simulator_interface import to_time
from hasel_sim.model import Model
from hasel_sim.parallel import executor
from std_msgs.msg import Header

from hasel_sysid.answer.diagnosis import Diagnosis, Finding, Verdict
from hasel_sysid.answer.result import Status
from hasel_sysid.answer.verdict import status_with
from hasel_sysid.candidates import effects_of
from hasel_sysid.dataset import for_model, prepared, simulable, usable
from hasel_sysid.estimation import FittedModel, fit_baseline, identify
from hasel_sysid.expected_work import plan_of_diagnosis, plan_of_fit
from hasel_sysid.experiment import GENTLEST
from hasel_sysid.improvement import diagnose
from hasel_sysid.live.running_error import RunningError
from hasel_sysid.policy import POLICY
from hasel_sysid.problem import Problem

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
    with executor(jobs or None) as pool:
        problem, start = _prepared(model, recordings, pool, workload)
        workload.expect(plan_of_fit(problem.work(start)))
        return identify(problem, start, method or DEFAULT_METHOD)


def diagnose_recordings(
    model: Model, recordings: Sequence[Recording], effects: Sequence[str], jobs: int, workload: Workload
) -> Diagnosis:
    """Fit and rank the effects (all known ones when none is named) that could be missing.

    workload: counts the simulations. Raises RecordingError, SysidError, SimulationError or ModelError.
    """
    with executor(jobs or None) as pool:
        problem, start = _prepared(model, recordings, pool, workload)
        workload.expect(plan_of_diagnosis(problem.work(start), len(effects_of(start, effects or None))))
        fit = fit_baseline(problem, start)
        return diagnose(problem, fit, effects or None)


def _prepared(
    model: Model, recordings: Sequence[Recording], pool: Executor, workload: Workload
) -> tuple[Problem, Model]:
    experiments = for_model(model.with_levels([]), usable(recordings))
    start = prepared(model, experiments)
    return Problem(simulable(start, experiments, pool, GENTLEST), pool, workload=workload), start


def status(diagnosis: Diagnosis) -> str:
    """What a diagnosis comes to, before any effect is added: one of the words of the Diagnosis message."""
    describes = diagnosis.goodness is not None and diagnosis.goodness.adequate
    if diagnosis.p_value >= POLICY.level:
        return (Status.NOTHING_MISSING if describes else Status.UNEXPLAINED).value
    missing = any(finding.verdict is Verdict.MISSING for finding in diagnosis.findings)
    left = 1.0 - diagnosis.explained
    return (status_with(left, describes) if missing else Status.UNEXPLAINED).value


def error_message(stamp_ns: int, error: RunningError, frame_id: str) -> msg.RunningError:
    """`/hasel/error` at a stamp [ns]."""
    return msg.RunningError(
        header=Header(stamp=to_time(stamp_ns), frame_id=frame_id),
        difference=error.difference,
        mean_absolute_error=error.mean_absolute,
        count=error.count,
        window_mean_absolute_error=error.recent,
        window=error.window,
    )


def parameter_messages(
    model: Model, at_bound: Collection[str] = (), undetermined: Collection[str] = ()
) -> list[msg.NamedParameter]:
    """Every free parameter of a model."""
    parameters = [model.parameters[name] for name in model.free]
    return [
        msg.NamedParameter(
            name=p.name,
            value=p.value,
            standard_error=math.nan if p.standard_error is None else p.standard_error,
            unit=p.unit,
            at_bound=p.name in at_bound,
            determined=p.name not in undetermined,
        )
        for p in parameters
    ]


def fit_message(result: FittedModel, model_file: str, header: Header) -> msg.Fit:
    """`/hasel/fit`; `model` is the file that was written, ready for the simulator's load_model."""
    return msg.Fit(
        header=header,
        model=model_file,
        effects=[effect.id for effect in result.model.effects],
        parameters=parameter_messages(result.model, result.at_bound, result.undetermined),
        mean_absolute_error=result.mean_absolute_error,
        mean_absolute_error_unseen=math.nan,
        messages=result.sentences,
    )


def diagnosis_message(found: Diagnosis, status: str, header: Header) -> msg.Diagnosis:
    """`/hasel/diagnosis`."""
    return msg.Diagnosis(
        header=header,
        status=status,
        missing=[finding.effect for finding in found.findings if finding.verdict is Verdict.MISSING],
        ranking=[_ranked(finding) for finding in found.findings],
        indistinguishable=[", ".join(group) for group in found.groups],
        noise_floor=found.measured.mean_absolute,
        unexplained_fraction=1.0 - found.explained,
    )


def _ranked(finding: Finding) -> msg.RankedEffect:
    parameters = [
        msg.NamedParameter(
            name=name,
            value=value,
            standard_error=error,
            unit=finding.units[name],
            determined=math.isfinite(error),
        )
        for name, (value, error) in finding.expected.items()
    ]
    return msg.RankedEffect(
        effect=finding.effect,
        probability=finding.probability,
        error_removed=finding.error_removed,
        verdict=str(finding),
        parameters=parameters,
    )
