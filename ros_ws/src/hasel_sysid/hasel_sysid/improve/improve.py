"""Fit, diagnose, add, refit: one effect after the other, each accepted only if runs left out of the fit agree."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from hasel_sim.errors import nearest_name
from hasel_sim.model import Model

from hasel_sysid.data_gate import Finding as SetUpFault
from hasel_sysid.diagnosis import diagnose
from hasel_sysid.diagnosis.adequacy import adequacy
from hasel_sysid.diagnosis.explained import Status
from hasel_sysid.diagnosis.search import WORTH_A_STEP
from hasel_sysid.errors import SysidError
from hasel_sysid.fit import FitResult, fit_from_afar, in_step
from hasel_sysid.fit.refinement import changes_by_refinement, with_numerical_error
from hasel_sysid.improve.by_sets import improve_by_sets
from hasel_sysid.improve.coarse_to_fine import far_start
from hasel_sysid.improve.conclusion import (
    conclude,
    is_noise,
    last_diagnosis,
    left_over,
    near_noise,
)
from hasel_sysid.improve.decision import Decision, decide
from hasel_sysid.improve.hindsight import with_hindsight
from hasel_sysid.improve.lawful import without_contradictions
from hasel_sysid.improve.neighbours import best_neighbour
from hasel_sysid.improve.promise import most_promised
from hasel_sysid.improve.prune import pruned
from hasel_sysid.improve.result import Improvement, Stage
from hasel_sysid.improve.set_up import opposed_runs
from hasel_sysid.problem import Problem
from hasel_sysid.searches import SEARCHES
from hasel_sysid.time_limit import TimeLimit

_ENOUGH = 0.03
"""With one run none can be left out to test a small effect: then less than this share of the error left is enough."""

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
    by: str = "greedy",
) -> Improvement:
    """Improve a model until what it leaves is noise or no known effect explains it, or the problem's time is over.

    validation: runs that are only ever compared with, never fitted or chosen by. only: names of the candidate effects
    (default: the whole catalogue). on_stage: called with every stage as soon as it is known, to write its model file.
    by: how to search, one of SEARCHES: one effect after the other, or among sets of effects.
    Raises SysidError for another search.
    """
    if by not in SEARCHES:
        raise SysidError(f"unknown search '{by}'; {nearest_name(by, SEARCHES)}")
    if by == "sets":
        return improve_by_sets(problem, model, validation, only, most_effects, progress, on_stage)
    report = _Reporter(progress)
    opposed = opposed_runs(problem, model)
    fit = fit_from_afar(problem, model, report.part("fit", 0.0, 0.15))
    stages = [_stage(fit, model, validation)]
    far = None
    if not opposed and not in_step(fit.evaluation):
        far = far_start(problem, fit.model, only, most_effects, report.part("far start", 0.15, 0.75))
    if far is not None:
        stages[0] = _completed(problem, replace(stages[0], diagnosis=far.first), on_stage)
        stages += [_stage(refit, model, validation) for refit in far.fits]
        stages[1:-1] = [_completed(problem, stage, on_stage) for stage in stages[1:-1]]
    reason, negligible = "", False
    for number in range(len(stages) - 1, most_effects):
        if number > 0 and problem.time_limit.is_over():
            reason = "What is left was not looked into any more."
            break
        found = diagnose(problem, stages[-1].fit, only, report.part("diagnosis", *report.share(number)))
        stages[-1] = _completed(problem, replace(stages[-1], diagnosis=found), on_stage)
        decision = decide(stages[-1], found)
        reason, negligible = decision.reason, decision.negligible
        if opposed:
            reason = f"A fault of the set-up comes before any effect: {'; '.join(map(str, opposed))}"
            break
        refit = _extended(problem, stages[-1], decision, most_effects)
        if refit is None:
            break
        stages.append(_stage(refit, model, validation))
        added = " and ".join(effect for effect in stages[-1].effects if effect not in stages[-2].effects)
        if far is None:
            stages[0] = with_hindsight(stages)
        if is_noise(refit, found):
            reason = f"What is left after adding {added} is noise."
            break
        if near_noise(refit, found) and most_promised(refit, found) < WORTH_A_STEP:
            reason = f"What is left after adding {added} is near the noise and looks like no other effect."
            negligible = True
            break
        left = left_over(stages)
        if left < _ENOUGH and len(problem.experiments) == 1:
            reason = (
                f"After adding {added}, {left:.1%} of the error above the noise is left: with one run, "
                "too little to find another effect in."
            )
            break
        if len(stages[-1].effects) >= most_effects:
            reason = f"Effect {most_effects} was the last: more effects could imitate anything."
            break
    else:
        reason = f"Step {most_effects} was the last: more effects could imitate anything."
    if stages[-1].diagnosis is None:
        stages[-1] = _completed(problem, stages[-1], on_stage)
    if problem.time_limit.left_something_out:
        reason = f"{reason} {_cut_short(stages, problem.time_limit)}"
    return _concluded(stages, reason, negligible, opposed)


def _cut_short(stages: Sequence[Stage], limit: TimeLimit) -> str:
    """What the search had no time for."""
    untried = last_diagnosis(stages).not_tried
    what = f"not tried: {', '.join(untried)}" if untried else "not every fit and set of effects was tried"
    return f"The search ended at {limit}; {what}."


def _concluded(
    stages: Sequence[Stage], reason: str, negligible: bool, opposed: Sequence[SetUpFault]
) -> Improvement:
    """The verdict, after the last look: is what was added a law, and does the model describe its runs?"""
    kept, refused, contradictions = without_contradictions(stages)
    if refused:
        reason, negligible = (
            f"{' and '.join(refused)} would lower the error, but by no law: not added.",
            False,
        )
    described = adequacy(kept[-1].fit.evaluation, last_diagnosis(kept).noise)
    found = conclude(kept, reason, negligible, contradictions, described.misfits)
    seen = kept[0].diagnosis.seen_beside(described.adequate, found.missing)
    kept[0] = replace(kept[0], diagnosis=seen)
    status = Status.UNEXPLAINED if opposed else found.status
    return replace(
        found, stages=kept, status=status, adequacy=described, refused=refused, opposed=bool(opposed)
    )


def _extended(problem: Problem, stage: Stage, decision: Decision, most_effects: int) -> FitResult | None:
    """The fit with the effect that was accepted, or of a better set next to the stage's; None to stop.

    Other sets are looked for only where no single effect leads to the noise.
    """
    accepted = None if decision.accepted is None else decision.accepted.fit
    if accepted is None and not decision.none_alone:
        return None
    if accepted is not None and near_noise(accepted, stage.diagnosis):
        return pruned(problem, accepted, stage.effects)
    better = best_neighbour(problem, stage.fit, stage.diagnosis, accepted, stage.effects, most_effects)
    return None if better is None else pruned(problem, better, stage.effects)


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


def _completed(problem: Problem, stage: Stage, on_stage: OnStage | None) -> Stage:
    """The stage with standard errors that also hold what its mesh and time step do, handed on."""
    known = None if stage.diagnosis is None else stage.diagnosis.changes
    changes = known or changes_by_refinement(problem, stage.fit.evaluation)
    complete = replace(stage, fit=with_numerical_error(stage.fit, changes))
    if on_stage:
        on_stage(complete)
    return complete
