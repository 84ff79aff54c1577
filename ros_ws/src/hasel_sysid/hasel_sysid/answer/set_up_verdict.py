# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The runs as recorded, or as a fault of the set-up has them read: which of the two is believed."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.answer.set_up import SetUpFault, hypotheses
from hasel_sysid.estimation.fit import FittedModel, fit_baseline
from hasel_sysid.expected_work import SET_UP, SET_UP_BESIDE
from hasel_sysid.model_checking import goodness_of_fit
from hasel_sysid.noise import allowed_noise
from hasel_sysid.noise_bounds import known_noise
from hasel_sysid.policy import Policy
from hasel_sysid.problem import Problem
from hasel_sysid.selection.choose import best_of
from hasel_sysid.selection.cross_validation import leave_one_run_out
from hasel_sysid.selection.search import Searched

SearchRuns = Callable[[Problem, FittedModel], Searched]
"""From runs and a baseline fitted to them to what it lacks."""


@dataclass(frozen=True)
class _Reading:
    """A fault of the set-up, the runs as they are then read, and a model fitted to them."""

    fault: SetUpFault
    problem: Problem
    fit: FittedModel


def recorded_or_read(
    problem: Problem, start: Model, fit: FittedModel, search: SearchRuns, policy: Policy
) -> tuple[Searched, SetUpFault | None]:
    """The search of the runs as recorded, or as the likeliest fault of the set-up has them read.

    A reading that alone describes the runs, or an answer as recorded that does, needs no second search. Otherwise the
    faults are asked for beside the likeliest model, too, and one is believed where the answer beside it predicts better
    and is likelier than the answer without it.
    """
    if _describes(problem, fit):
        return search(problem, fit), None
    with problem.workload.stage(SET_UP):
        readings = _readings(problem, [start, fit.model], fit)
    if readings and _describes(readings[0].problem, readings[0].fit):
        return search(readings[0].problem, readings[0].fit), readings[0].fault
    recorded = search(problem, fit)
    if goodness_of_fit(recorded.answer.fit.evaluation, recorded.likelihood.allowed).adequate:
        return recorded, None
    likeliest = recorded.models[best_of(recorded.models)].fitted.fit
    with problem.workload.stage(SET_UP_BESIDE):
        readings = [*_readings(problem, [likeliest.model], likeliest), *readings]
    if not readings or problem.time_limit.is_over():
        return recorded, None
    best = min(readings, key=lambda one: one.fit.evaluation.sum_of_squares)
    found = search(best.problem, fit_baseline(best.problem, fit.model))
    return (found, best.fault) if _is_believed(best.fault, found, recorded, policy) else (recorded, None)


def _readings(problem: Problem, about: Sequence[Model], fit: FittedModel) -> list[_Reading]:
    """The faults with which a model leaves less than this fit of it to the runs as recorded, likeliest first.

    about: models of these parameters, of which the better one on the runs as they are then read is fitted to them.
    """
    found = []
    for fault in hypotheses(problem, about):
        as_read = problem.with_experiments(fault.read(problem.experiments))
        begun = as_read.evaluate_each(about, [()] * len(about))
        able = [one for one in begun if not isinstance(one, SimulationError)]
        if not able:
            continue
        try:
            read = fit_baseline(as_read, min(able, key=lambda one: one.sum_of_squares).model)
        except SimulationError:
            continue
        if read.evaluation.sum_of_squares < fit.evaluation.sum_of_squares:
            found.append(_Reading(fault, as_read, read))
    return sorted(found, key=lambda one: one.fit.evaluation.sum_of_squares)


def _describes(problem: Problem, fit: FittedModel) -> bool:
    noise = known_noise(problem, [fit.evaluation])
    return goodness_of_fit(fit.evaluation, allowed_noise(noise, problem.discrepancy)).adequate


def _is_believed(fault: SetUpFault, found: Searched, recorded: Searched, policy: Policy) -> bool:
    """Both answers by the likelihood of the reading's search; that other runs are no better is no doubt of a fault that
    they do not have.
    """
    measured = found.answer.fit.evaluation.measured()
    with_it, without = (found.likelihood.whitened(one.answer) for one in (found, recorded))
    gain = with_it.logarithm - without.logarithm
    elpd, other = (leave_one_run_out(white, measured, policy.prior_runs) for white in (with_it, without))
    better = elpd.over(other)
    error = better.error if fault.everywhere else better.by_noise
    return gain > policy.reach * fault.size and better.total > policy.standard_errors * error
