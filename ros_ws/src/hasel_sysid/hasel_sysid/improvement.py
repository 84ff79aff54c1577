# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`diagnose` and `improve`: fit, search among sets of candidates, choose, and say what it comes to."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.answer.diagnosis import Diagnosis, Verdict
from hasel_sysid.answer.result import Improvement, Stage, Status, WrongConstant
from hasel_sysid.answer.set_up_verdict import recorded_or_read
from hasel_sysid.answer.verdict import diagnosis, share_left, status_with
from hasel_sysid.candidates import Candidate, effects_of
from hasel_sysid.estimation.fit import FittedModel, exact, fit_baseline, fitted_model, refined
from hasel_sysid.estimation.growing_horizon import horizons, in_phase
from hasel_sysid.expected_work import BEGINNINGS, ENDING
from hasel_sysid.model_checking import against_law, goodness_of_fit
from hasel_sysid.policy import POLICY, Policy
from hasel_sysid.problem import Problem
from hasel_sysid.selection.choose import best_of, is_better
from hasel_sysid.selection.likelihood import NOTHING, FittedSet, Likelihood
from hasel_sysid.selection.search import IsLaw, Search, Searched

OnStage = Callable[[Stage], None]


def diagnose(problem: Problem, fit: FittedModel, only: Sequence[str] | None = None) -> Diagnosis:
    """Rank every effect of the catalogue (or the named ones) as an explanation of what `fit` leaves.

    The search of `improve`, among sets of one effect. Raises ModelError for an unknown effect.
    """
    policy, effects = replace(POLICY, most_effects=1), effects_of(fit.model, only)
    found = Search(problem, fit, effects, policy, _laws(problem), with_constants=False).run()
    said = diagnosis(found, effects)
    named = said.best.fit if said.best is not None and said.best.verdict is Verdict.MISSING else None
    described = goodness_of_fit((fit if named is None else named).evaluation, said.noise)
    return replace(said.seen_beside(described.adequate), goodness=described)


def improve(
    problem: Problem,
    model: Model,
    validation: Problem | None = None,
    only: Sequence[str] | None = None,
    most_effects: int = POLICY.most_effects,
    on_stage: OnStage | None = None,
) -> Improvement:
    """Improve a model by the smallest set of effects that predicts runs left out of the fit as well as the best one.

    validation: runs that are only ever compared with, never fitted or chosen by. only: names of the candidate effects
    (default: the whole catalogue). on_stage: called with every stage as soon as it is known, to write its model file.
    Where the problem's time is over before the search is, the reason says what was not tried.
    """
    policy = replace(POLICY, most_effects=most_effects)
    fit = fit_baseline(problem, model)
    effects = effects_of(fit.model, only)
    stages: list[Stage] = []

    def add(fitted: FittedModel, names: Sequence[str], freed: str = "") -> None:
        error = None if validation is None else validation.evaluate(fitted.model).mean_absolute_error
        stages.append(Stage(tuple(names), fitted, error, None, freed))
        if on_stage:
            on_stage(stages[-1])

    add(refined(problem, fit), ())
    search = partial(_searched, effects=effects, policy=policy, with_constants=not only)
    found, fault = recorded_or_read(problem, model, fit, search, policy)
    if fault:
        problem = problem.with_experiments(fault.read(problem.experiments))
        validation = validation and validation.with_experiments(fault.read(validation.experiments))
        stages.clear()
        add(refined(problem, found.models[NOTHING].fitted.fit), ())
    said = diagnosis(found, effects)
    constant = _wrong_constant(found, policy)

    stages[0] = replace(stages[0], diagnosis=said.of_no_effect() if constant else said)
    with problem.workload.stage(ENDING):
        if constant:
            add(constant.fit, (), constant.name)
        else:
            for names in found.choice.path[1:]:
                order = [name for name in found.choice.in_order if name in names]
                add(refined(problem, exact(problem, found.models[names].fitted.fit)), order)
    reason, nothing_else = _why_the_last(found, policy, stages[0], constant)
    concluded = _conclude(stages, reason, nothing_else)
    if concluded.status is Status.NOTHING_MISSING and (doubt := _unseen_runs_differ(stages[-1], said)):
        concluded = replace(concluded, status=Status.UNEXPLAINED, unexplained_fraction=1.0, reason=doubt)
    if concluded.status is Status.UNEXPLAINED:
        of_none = replace(concluded.stages[0], diagnosis=concluded.diagnosis.of_no_effect())
        concluded = replace(concluded, stages=[of_none, *concluded.stages[1:]])
    untried = _what_was_not_tried(problem, said)
    return replace(
        concluded,
        reason=" ".join(filter(None, [concluded.reason, untried])),
        set_up=fault,
        constant=constant,
        models=found.table,
    )


def _unseen_runs_differ(stage: Stage, said: Diagnosis) -> str:
    """Why nothing is known to be missing though the fitted runs are described: the unseen ones are not."""
    unseen = stage.mae_validation
    if unseen is None or unseen <= POLICY.lack_of_fit * max(stage.mae_fit, said.noise.mean_absolute):
        return ""
    return (
        f"The fitted runs are described ({stage.mae_fit:.2g}), the unseen ones are not ({unseen:.2g}): fit runs "
        "that are more like them (levels and frequencies of the drive), or check their drive, times and units."
    )


def _laws(problem: Problem) -> IsLaw:
    """Whether what a fitted set adds has one value for every voltage and frequency; asked once of each."""
    known: dict[FittedSet, bool] = {}

    def is_law(fitted: FittedSet, likelihood: Likelihood) -> bool:
        names = [c.name for c in fitted.candidates.values() if not c.is_constant]
        if fitted not in known:
            noise = likelihood.allowed
            # what finer numerics change makes errors wider: what speaks for a law without it does so with it
            known[fitted] = not against_law(fitted.fit, noise, names) or not against_law(
                refined(problem, fitted.fit), noise, names
            )
        return known[fitted]

    return is_law


def _on_growing_horizons(
    problem: Problem, fit: FittedModel, effects: Sequence[Candidate], policy: Policy
) -> list[FittedSet]:
    """Sets that bring a model into phase with longer and longer horizons, fitted to all frames in the end."""
    sets: list[FittedSet] = []
    *shorter, whole = horizons(problem)
    for short in shorter:
        if problem.time_limit.is_over():
            break
        sets = _refitted(short, sets)
        if sets and in_phase(sets[0].fit.evaluation):
            continue
        here = fit_baseline(short, fit.model)
        if in_phase(here.evaluation) and not sets:
            continue
        found = Search(short, here, effects, policy, lambda *_: True, with_constants=False, begun=sets).run()
        wanted = [
            found.choice.chosen,
            *found.choice.rivals,
            *sorted(found.models, key=lambda n: -found.models[n].elpd.total),
        ]
        sets = [found.models[n].fitted for n in dict.fromkeys(wanted) if n][: policy.fits]
    return _refitted(whole, sets)


def _refitted(problem: Problem, sets: Sequence[FittedSet]) -> list[FittedSet]:
    """Sets of shorter runs as they are, or fitted, to longer ones; what leaves least comes first."""
    found = []
    for one in sets:
        try:
            as_it_is = fitted_model(problem.evaluate(one.fit.model, one.fit.model.free))
            fit = as_it_is if in_phase(as_it_is.evaluation) else exact(problem, as_it_is)
            found.append(FittedSet(one.candidates, exact(problem, fit)))
        except SimulationError:
            continue
    return sorted(found, key=lambda one: one.fit.evaluation.sum_of_squares)


def _searched(
    problem: Problem, fit: FittedModel, effects: Sequence[Candidate], policy: Policy, with_constants: bool
) -> Searched:
    """What a fitted baseline lacks; where it is out of phase, first of its beginning."""
    begun: list[FittedSet] = []
    if not in_phase(fit.evaluation):
        with problem.workload.stage(BEGINNINGS):
            begun = _on_growing_horizons(problem, fit, effects, policy)
    return Search(problem, fit, effects, policy, _laws(problem), with_constants, begun).run()


def _wrong_constant(found: Searched, policy: Policy) -> WrongConstant | None:
    """The number of the model file that is the answer, beside the effects that do as much, if any do."""
    (name,) = found.choice.chosen if len(found.choice.chosen) == 1 else ("",)
    answer = found.answer
    if not name or not answer.candidates[name].is_constant:
        return None
    effects = [n for n, m in found.models.items() if n and not m.fitted.has_constant]
    best = max(effects, key=lambda names: found.models[names].elpd.total, default=frozenset())
    if best and is_better(found.models, found.choice.chosen, best, policy):
        best = frozenset()
    (parameter,) = answer.candidates[name].parameters
    return WrongConstant(name, parameter.null, answer.fit, best)


def _conclude(stages: list[Stage], reason: str, nothing_else: bool) -> Improvement:
    """The verdict: is what was added a law, does it explain anything, and does the model describe its runs?"""
    last, noise = stages[-1], stages[0].diagnosed.noise
    against = against_law(last.fit, noise, last.effects)
    no_laws = tuple(dict.fromkeys(trend.parameter.partition(".")[0] for trend in against))
    contradictions = tuple(map(str, against))
    if no_laws:
        kept = [stage for stage in stages if not set(no_laws) & set(stage.effects)]
        reason = f"{listed(no_laws)} would lower the error, but by no law: not added."
        return replace(_judged(kept, reason, False, contradictions), refused=no_laws)
    concluded = _judged(stages, reason, nothing_else, contradictions)
    if concluded.status is Status.UNEXPLAINED and last.effects:
        reason = (
            f"{listed(last.effects)} would take away {1 - concluded.unexplained_fraction:.0%} of the error above the "
            "noise, which explains too little of it: not added."
        )
        return replace(_judged(stages[:1], reason, False, contradictions), refused=last.effects)
    return concluded


def _judged(
    stages: Sequence[Stage], reason: str, nothing_else: bool, contradictions: tuple[str, ...]
) -> Improvement:
    """The verdict on stages, baseline first, and the first one's diagnosis as it may be said beside it.

    nothing_else: whether what the last one leaves looks like noise. Nothing is explained, or found not to be missing,
    by a model that does not describe its runs to the noise.
    """
    said, last = stages[0].diagnosed, stages[-1]
    described = goodness_of_fit(last.fit.evaluation, said.noise)
    by_effects = [stage for stage in stages if not stage.constant]
    left = share_left(by_effects[0].mae_fit, by_effects[-1].mae_fit, said.noise)
    if last.effects:
        status = status_with(left, described.adequate, nothing_else)
    else:
        status = Status.NOTHING_MISSING if described.adequate and nothing_else else Status.UNEXPLAINED
        left = 0.0 if status is Status.NOTHING_MISSING else left
    missing = last.effects if status in (Status.EXPLAINED, Status.PARTLY_EXPLAINED) else ()
    first = replace(
        stages[0], diagnosis=replace(said.seen_beside(described.adequate, missing), goodness=described)
    )
    return Improvement(
        [first, *stages[1:]],
        status,
        missing,
        left,
        said.measured.mean_absolute,
        reason,
        contradictions,
        described,
    )


def _why_the_last(
    found: Searched, policy: Policy, first: Stage, constant: WrongConstant | None
) -> tuple[str, bool]:
    """Why the last stage is the last, in a sentence, and whether nothing else is missing."""
    if constant:
        return str(constant), False
    reason, nothing_else = _why_here(found, policy, first)
    if found.choice.no_laws:
        others = " and ".join(" + ".join(sorted(names)) for names in found.choice.no_laws)
        reason = f"{reason} {others} would do as well, but by no law."
    return reason, nothing_else


def _why_here(found: Searched, policy: Policy, first: Stage) -> tuple[str, bool]:
    chance, order = found.last.chance, found.choice.in_order
    nothing_else = chance >= policy.level
    looked_at = "effects that were tried" if first.diagnosed.not_tried else "listed effects"
    if not order:
        described = goodness_of_fit(first.fit.evaluation, first.diagnosed.noise).adequate
        if nothing_else and described:
            return f"Nothing is missing: noise alone looks like this in {chance:.0%} of cases.", True
        if nothing_else:
            return f"None of the {looked_at} stands out from what is left.", False
        best = best_of(found.models)
        why = f"none of the {looked_at} predicts left-out runs better than no effect does."
        if is_better(found.models, best, NOTHING, policy):
            why = (
                f"of the {looked_at} {listed(sorted(best))} would predict left-out runs better, but changes them by no "
                "more than noise may, or what no model has."
            )
        said = "Nothing that matters is missing: " if described else "Something is missing, but "
        return said + why, described
    if nothing_else:
        return f"What is left after adding {listed(order)} looks like no other effect.", True
    if len(order) >= policy.most_effects:
        return f"Effect {policy.most_effects} was the last: more effects could imitate anything.", False
    return (
        f"After adding {listed(order)} something is still missing, but none of the other {looked_at} predicts left-out "
        "runs better by more than one standard error.",
        False,
    )


def _what_was_not_tried(problem: Problem, first: Diagnosis) -> str:
    """What there was no time for, in a sentence; empty where there was time for everything."""
    if not problem.time_limit.left_something_out:
        return ""
    untried = f"not tried: {', '.join(first.not_tried)}" if first.not_tried else ""
    return f"The search ended at {problem.time_limit}; {untried or 'not every set of effects was tried'}."


def listed(names: Sequence[str]) -> str:
    """Names in a sentence: a, b and c."""
    return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))
