# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What can be done with a session: each gives a step or a finding, and changes nothing."""

from collections.abc import Mapping
from concurrent.futures import Executor
from contextlib import suppress
from functools import partial

from hasel_common.progress import Workload
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sysid.answer.next_run import Suggestion, fitted_briefly, rivals, suggest
from hasel_sysid.dataset import prepared
from hasel_sysid.errors import SysidError
from hasel_sysid.estimation import FittedModel, identify
from hasel_sysid.expected_work import USUAL_SPEED, plan_of_next_runs, work_of
from hasel_sysid.problem import Problem

from hasel_workbench.cards import source_of
from hasel_workbench.jobs import Progress
from hasel_workbench.state import SessionState
from hasel_workbench.step import Step

FIT = "model = h.fit(model, fitted).model"
_SMALLER = (1.0, 0.5, 0.25)
"""Shares of an effect's typical size that are tried until one can be simulated."""


def evaluated(
    state: SessionState,
    label: str,
    model: Model,
    pool: Executor,
    progress: Progress,
    did: tuple[str, ...],
    fit: FittedModel | None = None,
) -> Step:
    """Simulate all runs with a model and its derivatives by all free parameters.

    fit: of this very model, whose evaluation of the fitted runs is used. Raises SimulationError.
    """
    runs, unseen = state.experiments, state.unseen
    progress("simulating", 0.0)
    seen = fit.evaluation if fit is not None else Problem(runs, pool).evaluate(model, model.free)
    progress("simulating", 0.6)
    others = Problem(unseen, pool).evaluate(model, model.free) if unseen else None
    progress("where it fails", 0.9)
    step = Step(label, model, runs, unseen, seen, others, fit, did)
    step.comparison  # noqa: B018  worked out here, where waiting is no harm
    return step


def size_of(state: SessionState) -> float:
    """Work of simulating all fitted runs once with what is shown."""
    return work_of(state.shown.model, [each.run for each in state.experiments])


def fitted(state: SessionState, pool: Executor, work: Workload) -> tuple[Step, FittedModel]:
    """What is being tried, else the current step, fitted; and the fit that it holds."""
    shown = state.shown
    model = prepared(shown.model, state.experiments)
    result = identify(Problem(state.experiments, pool, workload=work), model, "least_squares")
    label, did = (shown.label, (*shown.did, FIT)) if state.trial else ("fit", (FIT,))
    return evaluated(state, label, result.model, pool, lambda *_: work.check(), did, result), result


def with_effect(
    state: SessionState, effect: str, only: tuple[str, ...] | None, pool: Executor, progress: Progress
) -> Step:
    """The current step with an effect: as fitted in a diagnosis, as expected there, or at its typical size."""
    current = state.current
    source = source_of(current.model, effect, only)
    label, add = f"+ {effect}", f"model = model.with_effects({source!r})"
    finding = None
    if state.diagnosis is not None and state.diagnosed == state.at:
        finding = next((each for each in state.diagnosis.findings if each.effect == effect), None)
    if finding is not None and finding.fit is not None:
        found = finding.fit.model
        return evaluated(state, label, found, pool, progress, (add, _values_line(found.values)), finding.fit)
    model = current.model.with_effects(source)

    def at(share: float) -> Step:
        values = _sized(model, effect, share)
        if finding is not None and finding.expected and finding.is_plausible and share == 1.0:
            values |= {name: value for name, (value, _) in finding.expected.items()}
        did = (add, _values_line(values))
        return evaluated(state, label, model.with_values(values), pool, progress, did)

    for share in _SMALLER[:-1]:
        with suppress(SimulationError):
            return at(share)
    return at(_SMALLER[-1])


def without_effect(state: SessionState, effect: str, pool: Executor, progress: Progress) -> Step:
    """The current step without one of its effects."""
    model = state.current.model.without_effects(effect)
    did = (f"model = model.without_effects({effect!r})",)
    return evaluated(state, f"− {effect}", model, pool, progress, did)


def with_values(state: SessionState, values: Mapping[str, float], pool: Executor, progress: Progress) -> Step:
    """What is shown, with other values; those outside their bounds are moved onto them."""
    shown = state.shown
    known = [(shown.model.parameter(name), float(value)) for name, value in values.items()]
    values = {p.name: min(max(value, p.lower), p.upper) for p, value in known}
    model = shown.model.with_values(values, dict.fromkeys(values))
    label = shown.label if state.trial else "by hand"
    did = (*(shown.did if state.trial else ()), _values_line(values))
    return evaluated(state, label, model, pool, progress, did)


def suggestions(state: SessionState, pool: Executor, progress: Progress) -> tuple[Suggestion, ...]:
    """The runs that best tell apart what the last diagnosis left in doubt, at no more than was driven already."""
    if state.diagnosis is None:
        raise SysidError("nothing was diagnosed so far; expected a ranking to decide about: diagnose first")
    work = Workload(plan_of_next_runs(size_of(state)), usual_speed=USUAL_SPEED, tell=progress)
    problem = Problem(state.experiments, pool, workload=work)
    candidates = rivals(state.diagnosis, partial(fitted_briefly, problem))
    highest = max(state.current.model.levels, default=0.0)
    found = suggest(pool, candidates, state.diagnosis.noise, float(highest), work, brief=True)
    if not found:
        raise SysidError(
            "no experiment of the library can be simulated with these explanations: plan it by hand"
        )
    return tuple(found)


def _sized(model: Model, effect: str, share: float) -> dict[str, float]:
    """Values of an effect, a share of the way from doing nothing to its typical size."""
    kind = next(each for each in model.effects if each.id == effect)
    return {
        f"{effect}.{p.name}": p.typical if p.scan else p.null + share * (p.typical - p.null)
        for p in kind.parameters
    }


def _values_line(values: Mapping[str, float]) -> str:
    numbers = ", ".join(f"{name!r}: {float(value)!r}" for name, value in values.items())
    return f"model = model.with_values({{{numbers}}})"
