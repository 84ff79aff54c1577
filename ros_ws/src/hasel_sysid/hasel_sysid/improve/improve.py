"""Fit, diagnose, add, refit: one effect after the other, each accepted only if runs left out of the fit agree."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from hasel_sim.model import Model

from hasel_sysid.diagnosis import Diagnosis, Finding, Verdict, diagnose
from hasel_sysid.diagnosis.judgement import SIGNIFICANT
from hasel_sysid.diagnosis.left_out import left_out_squares
from hasel_sysid.fit import FitResult, fit_least_squares
from hasel_sysid.improve.exchange import exchanged
from hasel_sysid.improve.result import Improvement, Stage, Status
from hasel_sysid.problem import Problem

_EXPLAINED = 0.9
"""Share of the baseline's error above the noise that accepted effects must remove to be an explanation."""
_PARTLY = 0.6
_ENOUGH = 0.03
"""Less than this share of the error left is no reason to look for another effect."""
_NOISE = 1.03
"""A mean error up to this many times the noise's is noise."""
_LEAST_GAIN = 0.03
"""An effect must lower the sum of squares by this share: less is not worth a parameter."""

Progress = Callable[[str, float], None]
OnStage = Callable[[Stage], None]


def improve(
    problem: Problem,
    model: Model,
    validation: Problem | None = None,
    only: Sequence[str] | None = None,
    most_effects: int = 3,
    progress: Progress | None = None,
    on_stage: OnStage | None = None,
) -> Improvement:
    """Improve a model until what it leaves is noise or no known effect explains it.

    validation: runs that are only ever compared with, never fitted or chosen by. only: names of the candidate effects
    (default: the whole catalogue). on_stage: called with every stage as soon as it is known, to write its model file.
    """
    report = _Reporter(progress)
    fit = fit_least_squares(problem, model, report.part("fit", 0.0, 0.15))
    stages = [_stage(fit, model, validation)]
    reason = ""
    for number in range(most_effects):
        found = diagnose(problem, stages[-1].fit, only, report.part("diagnosis", *report.share(number)))
        stages[-1] = replace(stages[-1], diagnosis=found)
        if on_stage:
            on_stage(stages[-1])
        accepted, reason = _accepted(stages[-1], found)
        if accepted is None:
            break
        refit = exchanged(problem, stages, accepted)
        stages.append(_stage(refit, model, validation))
        if _is_noise(refit, found):
            reason = f"What is left after adding {accepted.effect} is noise."
            break
        left = _left_over(stages)
        if left < _ENOUGH:
            reason = (
                f"After adding {accepted.effect}, {left:.1%} of the error above the noise is left: enough."
            )
            break
    if stages[-1].diagnosis is None and on_stage:
        on_stage(stages[-1])
    return _conclude(stages, reason)


class _Reporter:
    """Maps the progress of the parts to that of the whole."""

    def __init__(self, progress: Progress | None) -> None:
        self._progress = progress

    def share(self, number: int) -> tuple[float, float]:
        """Where the diagnosis of one stage begins and ends."""
        return (
            (0.15, 0.75) if number == 0 else (0.75 + 0.25 * (1 - 0.5 ** (number - 1)), 1 - 0.25 * 0.5**number)
        )

    def part(self, name: str, begin: float, end: float) -> Progress | None:
        if self._progress is None:
            return None
        return lambda text, done: self._progress(f"{name}: {text}", begin + (end - begin) * min(done, 1.0))


def _stage(fit: FitResult, first: Model, validation: Problem | None) -> Stage:
    before = {effect.id for effect in first.effects}
    added = tuple(effect.id for effect in fit.model.effects if effect.id not in before)
    error = None if validation is None else validation.evaluate(fit.model).mean_absolute_error
    return Stage(added, fit, error)


def _accepted(stage: Stage, found: Diagnosis) -> tuple[Finding | None, str]:
    """The finding to act on after a stage, or None and the reason."""
    fit, added = stage.fit, stage.effects
    candidates = [f for f in found.findings if f.verdict is Verdict.MISSING and f.fit is not None]
    if found.p_value >= SIGNIFICANT:
        what = "What is left is noise" if added else "Nothing is missing"
        return None, f"{what}: noise alone looks like this in {found.p_value:.0%} of cases."
    numerics = {name: share for name, share in found.suspects.items() if share > max(0.5, found.explained)}
    if numerics:
        name = max(numerics, key=numerics.get)
        return (
            None,
            f"The {name.replace('_', ' ')} explains {numerics[name]:.0%} of what is left: refine it first.",
        )
    if not candidates:
        return None, _none_convinces(found)
    best = candidates[0]
    gain = 1 - best.fit.evaluation.sum_of_squares / fit.evaluation.sum_of_squares
    if gain < _LEAST_GAIN:
        return (
            None,
            f"Nothing that matters is missing: {best.effect} would lower the squared error by {gain:.1%}.",
        )
    if left_out_squares(best.fit.evaluation) >= left_out_squares(fit.evaluation):
        return (
            None,
            f"{best.effect} fits better but predicts runs left out of the fit worse: it is not accepted.",
        )
    return best, ""


def _none_convinces(found: Diagnosis) -> str:
    """Why no effect is accepted although something is missing."""
    learned = f"a learned model of the residual {found.ceiling:.0%}"
    if found.explained < _EXPLAINED:
        return (
            f"None of the listed effects explains what is left: the best removes {found.explained:.0%} of the error "
            f"above the noise, {learned}."
        )
    return (
        f"None of the listed effects explains what is left with a plausible value: one removes {found.explained:.0%} "
        f"of the error above the noise, but only at the edge of its range; {learned}."
    )


def _is_noise(fit: FitResult, found: Diagnosis) -> bool:
    """Whether what is left is no more than the noise of the diagnosis before."""
    return fit.mean_absolute_error <= _NOISE * found.noise.mean_absolute


def _left_over(stages: list[Stage]) -> float:
    """Share of the baseline's mean error above the noise that the last stage leaves, 0 to 1.

    Of the mean |Δ sin θ|, not of its square, which would call a law of the wrong shape an explanation.
    """
    found = next(stage.diagnosis for stage in reversed(stages) if stage.diagnosis is not None)
    base, left = (stage.fit.mean_absolute_error for stage in (stages[0], stages[-1]))
    floor = _NOISE * found.noise.mean_absolute
    return float(np.clip((left - floor) / max(base - floor, 1e-12), 0.0, 1.0))


def _conclude(stages: list[Stage], reason: str) -> Improvement:
    first = stages[0].diagnosis
    last = next(stage.diagnosis for stage in reversed(stages) if stage.diagnosis is not None)
    unexplained = _left_over(stages)
    added = stages[-1].effects
    rest = stages[-1].diagnosis
    if first.p_value >= SIGNIFICANT:
        status, unexplained = Status.NOTHING_MISSING, 0.0
    elif not added:
        nothing = reason.startswith("Nothing that matters")
        status = Status.NOTHING_MISSING if nothing else Status.UNEXPLAINED
    elif unexplained <= 1 - _EXPLAINED or (rest is not None and rest.p_value >= SIGNIFICANT):
        status = Status.EXPLAINED
    else:
        status = Status.PARTLY_EXPLAINED if unexplained <= 1 - _PARTLY else Status.UNEXPLAINED
    missing = added if status in (Status.EXPLAINED, Status.PARTLY_EXPLAINED) else ()
    return Improvement(stages, status, missing, unexplained, last.noise.mean_absolute, reason)
