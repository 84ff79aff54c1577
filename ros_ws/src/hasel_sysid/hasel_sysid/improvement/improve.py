"""Fit, search among sets of effects, choose, and say what it comes to."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache, partial

from hasel_sim.model import Model

from hasel_sysid.diagnosis import Diagnosis
from hasel_sysid.diagnosis.adequacy import adequacy
from hasel_sysid.diagnosis.candidates import candidate_effects
from hasel_sysid.diagnosis.explained import Status
from hasel_sysid.estimation import FitResult, fit_from_afar, in_step, is_close
from hasel_sysid.estimation.refinement import changes_by_refinement, with_numerical_error
from hasel_sysid.improvement.conclusion import conclude, last_diagnosis, near_noise
from hasel_sysid.improvement.from_afar import from_afar
from hasel_sysid.improvement.lawful import against_law, without_contradictions
from hasel_sysid.improvement.result import Improvement, Stage
from hasel_sysid.improvement.set_up import opposed_runs
from hasel_sysid.problem import Problem
from hasel_sysid.selection import POLICY, Choice, Policy, Searched, choose, search
from hasel_sysid.selection.sets import EffectSet, FittedSet, name_of
from hasel_sysid.selection.simulated_sets import SimulatedSets
from hasel_sysid.selection.verdicts import diagnosis, noise_allowed

_CREDIT = (
    "takes away a tenth of the squared error that finer numerics leave and foretells left-out runs better"
)

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
    policy = replace(POLICY, most_effects=most_effects)
    opposed = opposed_runs(problem, model)
    fit = fit_from_afar(problem, model, _part(progress, "fit", 0.0, 0.15))
    changes = changes_by_refinement(problem, fit.evaluation)
    near = in_step(fit.evaluation)
    effects = candidate_effects(fit.model, tuple(only) if only else None)
    begun = () if near or opposed else from_afar(problem, fit, effects, policy, partial(_part, progress))
    far_off = near and not is_close(fit.evaluation)
    slack, given = list(changes.values()) if near else (), model if far_off else None
    sets = SimulatedSets(problem, fit, effects, slack, given)
    refined = cache(partial(_refined, problem))

    def lawful(found: Searched, effects: EffectSet) -> bool:
        known, noise, names = found.known[effects], noise_allowed(sets, found), sorted(effects)
        # what finer numerics change makes errors wider: what speaks for a law without it does so with it
        return not (against_law(known.fit, noise, names) and against_law(refined(known), noise, names))

    def described(found: Searched, effects: EffectSet) -> bool:
        return adequacy(found.known[effects].fit.evaluation, noise_allowed(sets, found)).adequate

    report = _part(progress, "search", 0.25, 0.95)
    found = search(sets, policy, report, begun, lawful=lawful, described=described)
    choice = choose(found, policy, partial(lawful, found))
    said = diagnosis(sets, found, choice, changes)
    stages = [_stage(with_numerical_error(fit, changes), (), validation, said)]
    if on_stage:
        on_stage(stages[0])
    path = () if opposed else choice.path[1:]
    for effects_so_far, fitted in zip(path, sets.finished([found.known[s] for s in path]), strict=True):
        order = _in_order(choice, effects_so_far)
        fit_so_far = refined(fitted)
        stages.append(_stage(fit_so_far, order, validation, None))
        if on_stage:
            on_stage(stages[-1])
    if opposed:
        reason, done = (
            f"A fault of the set-up comes before any effect: {'; '.join(map(str, opposed))}",
            False,
        )
    else:
        reason, done = _why_here(found, choice, policy, stages[0])
        if choice.lawless:
            reason = f"{reason} {' and '.join(map(name_of, choice.lawless))} would do as well, but by no law."
    if problem.time_limit.left_something_out:
        untried = said.not_tried
        what = f"not tried: {', '.join(untried)}" if untried else "not every set of effects was tried"
        reason = f"{reason} The search ended at {problem.time_limit}; {what}."
    return _concluded(stages, reason, done, bool(opposed))


def _why_here(found: Searched, choice: Choice, policy: Policy, first: Stage) -> tuple[str, bool]:
    """Why the chosen set is the last, in a sentence, and whether nothing else is missing."""
    chance = found.tested(choice.chosen).chance
    nothing_else = chance >= policy.level
    if not choice.chosen:
        if nothing_else and near_noise(first.fit, first.diagnosis):
            return f"Nothing is missing: noise alone looks like this in {chance:.0%} of cases.", True
        if nothing_else:
            return "None of the listed effects stands out from what is left.", False
        trifle = near_noise(first.fit, first.diagnosis)
        what = "Nothing that matters is missing: no" if trifle else "Something is missing, but no"
        return (
            f"{what} listed effect foretells runs that are left out of the fit better than none does.",
            trifle,
        )
    added = " and ".join(_in_order(choice, choice.chosen))
    if nothing_else:
        return f"What is left after adding {added} looks like no other effect.", True
    if len(choice.chosen) >= policy.most_effects:
        return f"Effect {policy.most_effects} was the last: more effects could imitate anything.", False
    nearest = f"; nearest was {name_of(found.best)}" if found.best != choice.chosen else ""
    return (
        f"After adding {added} something is still missing, but no further effect {_CREDIT}{nearest}.",
        False,
    )


def _in_order(choice: Choice, effects: EffectSet) -> tuple[str, ...]:
    """Effects of a set in the order in which the path to the chosen one takes them in."""
    order: list[str] = []
    for step in choice.path:
        order += sorted(step - set(order))
    return tuple(effect for effect in order if effect in effects)


def _refined(problem: Problem, fitted: FittedSet) -> FitResult:
    """The fit of a set, with what finer numerics would change."""
    fit: FitResult = fitted.fit
    return with_numerical_error(fit, changes_by_refinement(problem, fit.evaluation))


def _stage(
    fit: FitResult, effects: Sequence[str], validation: Problem | None, said: Diagnosis | None
) -> Stage:
    error = None if validation is None else validation.evaluate(fit.model).mean_absolute_error
    return Stage(tuple(effects), fit, error, said)


def _concluded(stages: list[Stage], reason: str, nothing_else: bool, opposed: bool) -> Improvement:
    """The verdict: is what was added a law, and does the model describe its runs?"""
    kept, refused, contradictions = without_contradictions(stages)
    if refused:
        reason = f"{' and '.join(refused)} would lower the error, but by no law: not added."
        nothing_else = False
    described = adequacy(kept[-1].fit.evaluation, last_diagnosis(kept).noise)
    concluded = conclude(kept, reason, nothing_else, contradictions, described.misfits)
    first = kept[0].diagnosis
    seen = replace(first.seen_beside(described.adequate, concluded.missing), adequacy=described)
    kept[0] = replace(kept[0], diagnosis=seen)
    status = Status.UNEXPLAINED if opposed else concluded.status
    return replace(
        concluded, stages=kept, status=status, adequacy=described, refused=refused, opposed=opposed
    )


def _part(progress: Progress | None, name: str, begin: float, end: float) -> Progress | None:
    if progress is None:
        return None
    return lambda text, done: progress(f"{name}: {text}", begin + (end - begin) * min(done, 1.0))
