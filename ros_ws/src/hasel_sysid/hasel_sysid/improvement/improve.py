"""Fit, search among sets of effects, choose, and say what it comes to."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import chain

from hasel_sim.model import Model

from hasel_sysid.diagnosis import Diagnosis
from hasel_sysid.diagnosis.adequacy import adequacy
from hasel_sysid.diagnosis.candidates import candidate_effects
from hasel_sysid.diagnosis.explained import Status
from hasel_sysid.estimation import FitResult, fit_from_afar, in_step, is_close
from hasel_sysid.estimation.refinement import changes_by_refinement, refined, with_numerical_error
from hasel_sysid.improvement.conclusion import conclude, last_diagnosis
from hasel_sysid.improvement.from_afar import from_afar
from hasel_sysid.improvement.judges import Judges
from hasel_sysid.improvement.lawful import without_contradictions
from hasel_sysid.improvement.reasons import (
    by_no_law,
    in_order,
    too_little,
    what_was_not_tried,
    why_the_last,
)
from hasel_sysid.improvement.result import Improvement, Stage
from hasel_sysid.improvement.set_up import opposed_runs
from hasel_sysid.improvement.wrong_constant import WrongConstant
from hasel_sysid.problem import Problem
from hasel_sysid.selection import POLICY, choose, search
from hasel_sysid.selection.simulated_sets import SimulatedSets
from hasel_sysid.selection.verdicts import diagnosis

Progress = Callable[[str, float], None]
OnStage = Callable[[Stage], None]


def improve(
    problem: Problem,
    model: Model,
    validation: Problem | None = None,
    only: Sequence[str] | None = None,
    most_effects: int = POLICY.most_effects,
    progress: Progress | None = None,
    on_stage: OnStage | None = None,
) -> Improvement:
    """Improve a model by the smallest set of effects that foretells runs left out of the fit as well as the best one.

    validation: runs that are only ever compared with, never fitted or chosen by. only: names of the candidate effects
    (default: the whole catalogue). on_stage: called with every stage as soon as it is known, to write its model file.
    Where the problem's time is over before the search is, the reason says what was not tried.
    """
    opposed = opposed_runs(problem, model)
    # beside a fault of the set-up nothing is named: the ranking is all that a search is for
    policy = replace(POLICY, most_effects=1 if opposed else most_effects)
    fit = fit_from_afar(problem, model, _part(progress, "fit", 0.0, 0.15))
    changes = changes_by_refinement(problem, fit.evaluation)
    near = in_step(fit.evaluation)
    effects = candidate_effects(fit.model, tuple(only) if only else None)
    begun = () if near or opposed else from_afar(problem, fit, effects, policy, partial(_part, progress))
    far_off = near and not is_close(fit.evaluation)
    slack, given = list(changes.values()) if near else (), model if far_off else None
    sets = SimulatedSets(problem, fit, effects, slack, given)
    judges = Judges(sets, policy, opposed)
    report = _part(progress, "search", 0.25, 0.95)
    found = search(sets, policy, report, begun, judges)
    choice = choose(found, policy, partial(judges.lawful, found))
    said = diagnosis(sets, found, choice, changes)
    constant = judges.constant(found, choice.chosen)
    if constant:
        constant = replace(constant, fit=refined(problem, constant.fit))
        said = said.of_no_effect()
    stages = [_stage(with_numerical_error(fit, changes), (), validation, said)]
    if on_stage:
        on_stage(stages[0])
    if constant:
        stages.append(_stage(constant.fit, (), validation, None, constant.name))
        if on_stage:
            on_stage(stages[-1])
    path = () if opposed or constant else choice.path[1:]
    fits = [found.known[effects_so_far] for effects_so_far in path]
    # what explains too little or is no law is not added, and needs no last digits
    named, lawless = judges.named(found, choice.chosen), judges.lawless(found, choice.chosen)
    added = [fitted for fitted in fits if named and not lawless & fitted.effects]
    ended = chain(sets.finished(added), fits[len(added) :])
    for effects_so_far, fitted in zip(path, ended, strict=True):
        order = in_order(choice, effects_so_far)
        stages.append(_stage(judges.refined(fitted), order, validation, None))
        if on_stage:
            on_stage(stages[-1])
    reason, done = why_the_last(found, choice, policy, stages[0], opposed, constant)
    concluded = _concluded(stages, reason, done, bool(opposed), constant)
    untried = what_was_not_tried(problem.time_limit, said)
    return replace(concluded, reason=f"{concluded.reason} {untried}") if untried else concluded


def _stage(
    fit: FitResult,
    effects: Sequence[str],
    validation: Problem | None,
    said: Diagnosis | None,
    constant: str = "",
) -> Stage:
    error = None if validation is None else validation.evaluate(fit.model).mean_absolute_error
    return Stage(tuple(effects), fit, error, said, constant)


def _concluded(
    stages: list[Stage], reason: str, nothing_else: bool, opposed: bool, constant: WrongConstant | None
) -> Improvement:
    """The verdict: is what was added a law, does it explain anything, and does the model describe its runs?"""
    kept, refused, contradictions = without_contradictions(stages)
    if refused:
        reason, nothing_else = by_no_law(refused), False
    concluded = _judged(kept, reason, nothing_else, contradictions)
    tried = kept[-1].effects
    if concluded.status is Status.UNEXPLAINED and tried:
        refused = (*refused, *tried)
        reason = too_little(tried, concluded.unexplained_fraction)
        concluded = _judged(kept[:1], reason, False, contradictions)
    if opposed:
        concluded = replace(concluded, status=Status.UNEXPLAINED)
    if concluded.status is Status.UNEXPLAINED:
        of_none = replace(concluded.stages[0], diagnosis=concluded.diagnosis.of_no_effect())
        concluded = replace(concluded, stages=[of_none, *concluded.stages[1:]])
    return replace(concluded, refused=refused, opposed=opposed, constant=constant)


def _judged(
    stages: list[Stage], reason: str, nothing_else: bool, contradictions: Sequence[str]
) -> Improvement:
    """The verdict on stages, and the first one's diagnosis as it may be said beside it."""
    described = adequacy(stages[-1].fit.evaluation, last_diagnosis(stages).noise)
    concluded = conclude(stages, reason, nothing_else, contradictions, described.misfits)
    seen = stages[0].diagnosis.seen_beside(described.adequate, concluded.missing)
    first = replace(stages[0], diagnosis=replace(seen, adequacy=described))
    return replace(concluded, stages=[first, *stages[1:]], adequacy=described)


def _part(progress: Progress | None, name: str, begin: float, end: float) -> Progress | None:
    if progress is None:
        return None
    return lambda text, done: progress(f"{name}: {text}", begin + (end - begin) * min(done, 1.0))
