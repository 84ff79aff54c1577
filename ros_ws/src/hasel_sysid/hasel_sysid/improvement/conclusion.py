"""What the stages of an improvement come to."""

from collections.abc import Sequence

from hasel_sysid.diagnosis import Diagnosis
from hasel_sysid.diagnosis.adequacy import Misfit
from hasel_sysid.diagnosis.explained import Status, near_noise, share_left, status_with
from hasel_sysid.improvement.result import Improvement, Stage
from hasel_sysid.policy import POLICY


def last_diagnosis(stages: Sequence[Stage]) -> Diagnosis:
    """That of the last stage that was diagnosed."""
    return next(stage.diagnosis for stage in reversed(stages) if stage.diagnosis is not None)


def left_over(stages: Sequence[Stage]) -> float:
    """Share of the baseline's mean error above the noise that the last stage's effects leave, 0 to 1."""
    by_effects = [stage for stage in stages if not stage.constant]
    before, after = by_effects[0].fit.mean_absolute_error, by_effects[-1].fit.mean_absolute_error
    return share_left(before, after, last_diagnosis(stages).noise.mean_absolute)


def conclude(
    stages: Sequence[Stage],
    reason: str,
    negligible: bool = False,
    contradictions: Sequence[str] = (),
    misfits: Sequence[Misfit] = (),
) -> Improvement:
    """The verdict on all stages, baseline first.

    reason: why the last one is the last; negligible: whether all that could be added would hardly matter;
    contradictions: what speaks against the effects that were tried, whatever they explain; misfits: regimes in which
    the last stage does not describe its runs. Nothing is explained, or found not to be missing, by a model that does
    not describe its runs to the noise.
    """
    first, last, rest = stages[0].diagnosis, last_diagnosis(stages), stages[-1].diagnosis
    unexplained = left_over(stages)
    added = stages[-1].effects
    describes = near_noise(stages[-1].mae_fit, last.noise) and not misfits
    nothing_left = negligible or (rest is not None and rest.p_value >= POLICY.level)
    if not added:
        missing_nothing = describes and (negligible or first.p_value >= POLICY.level)
        status = Status.NOTHING_MISSING if missing_nothing else Status.UNEXPLAINED
        unexplained = 0.0 if missing_nothing else unexplained
    else:
        status = status_with(unexplained, describes, nothing_left)
        if status is Status.EXPLAINED and contradictions:
            status = Status.PARTLY_EXPLAINED
    missing = added if status in (Status.EXPLAINED, Status.PARTLY_EXPLAINED) else ()
    return Improvement(
        list(stages), status, missing, unexplained, last.measured.mean_absolute, reason, tuple(contradictions)
    )
