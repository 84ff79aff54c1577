"""Results of the identification as ROS messages."""

import math

from hasel_interfaces.msg import Diagnosis, Fit, NamedParameter, RankedEffect, RunningError
from hasel_sim.live.simulator_interface import to_time
from hasel_sim.model import Model
from std_msgs.msg import Header

from hasel_sysid import result as diagnosis_result
from hasel_sysid.diagnosis import Finding, Verdict
from hasel_sysid.estimation import FittedModel
from hasel_sysid.live import running_error


def error_message(stamp_ns: int, error: running_error.RunningError, frame_id: str) -> RunningError:
    """`/hasel/error` at a stamp [ns]."""
    return RunningError(
        header=Header(stamp=to_time(stamp_ns), frame_id=frame_id),
        difference=error.difference,
        mean_absolute_error=error.mean_absolute,
        count=error.count,
        window_mean_absolute_error=error.recent,
        window=error.window,
    )


def parameter_messages(model: Model, at_bound=(), undetermined=()) -> list[NamedParameter]:
    """Every free parameter of a model."""
    parameters = [model.parameters[name] for name in model.free]
    return [
        NamedParameter(
            name=p.name,
            value=p.value,
            standard_error=math.nan if p.standard_error is None else p.standard_error,
            unit=p.unit,
            at_bound=p.name in at_bound,
            determined=p.name not in undetermined,
        )
        for p in parameters
    ]


def fit_message(result: FittedModel, model_file: str, header: Header) -> Fit:
    """`/hasel/fit`; `model` is the file that was written, ready for the simulator's load_model."""
    return Fit(
        header=header,
        model=model_file,
        effects=[effect.id for effect in result.model.effects],
        parameters=parameter_messages(result.model, result.at_bound, result.undetermined),
        mean_absolute_error=result.mean_absolute_error,
        mean_absolute_error_unseen=math.nan,
        messages=result.sentences,
    )


def diagnosis_message(found: diagnosis_result.Diagnosis, status: str, header: Header) -> Diagnosis:
    """`/hasel/diagnosis`."""
    return Diagnosis(
        header=header,
        status=status,
        missing=[finding.effect for finding in found.findings if finding.verdict is Verdict.MISSING],
        ranking=[_ranked(finding) for finding in found.findings],
        indistinguishable=[", ".join(group) for group in found.groups],
        noise_floor=found.measured.mean_absolute,
        unexplained_fraction=1.0 - found.explained,
    )


def _ranked(finding: Finding) -> RankedEffect:
    parameters = [
        NamedParameter(
            name=name,
            value=value,
            standard_error=error,
            unit=finding.units[name],
            determined=math.isfinite(error),
        )
        for name, (value, error) in finding.expected.items()
    ]
    return RankedEffect(
        effect=finding.effect,
        probability=finding.probability,
        error_removed=finding.error_removed,
        verdict=str(finding),
        parameters=parameters,
    )
