"""Which constants of a model file are worth a fit, and where it begins."""

from collections.abc import Mapping

import numpy as np
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sim.model.constants import shared_constants

from hasel_sysid.draft import draft
from hasel_sysid.improvement.constant_look import Look, look_of, most_promising, one_step_on
from hasel_sysid.improvement.constants_over_decades import over_decades
from hasel_sysid.improvement.freed_constant import freed, held_constants, is_possible
from hasel_sysid.policy import Policy
from hasel_sysid.problem import Evaluation, Problem


def beside_what_is_close(
    problem: Problem, fitted: Evaluation, least: float, policy: Policy
) -> dict[str, Model]:
    """The fitted model with a constant free, by name, where a fit of it begins; most promising first.

    least: squares that other models leave.
    """
    looks = _close(problem, fitted, least, policy)
    return _begin({look.name: freed(fitted.model, look.name) for look in looks}, policy)


def beside_what_is_far_off(
    problem: Problem, fitted: Evaluation, policy: Policy, given: Model | None = None
) -> dict[str, Model]:
    """The same for what constants promise over their ranges, beside what was fitted and beside what was given."""
    wider = policy.wider()
    begun = [fitted, *_as_given(problem, fitted, given)]
    looks = over_decades(problem, begun, wider)
    return _begin({look.name: freed(fitted.model, look.name).with_values(look.step) for look in looks}, wider)


def _begin(models: Mapping[str, Model], policy: Policy) -> dict[str, Model]:
    possible = [(name, model) for name, model in models.items() if is_possible(model, name)]
    return dict(possible[: policy.effort.fits])


def _as_given(problem: Problem, fitted: Evaluation, given: Model | None) -> list[Evaluation]:
    try:
        return [] if given is None else [problem.evaluate(given, fitted.names)]
    except SimulationError:
        return []


def _close(problem: Problem, fitted: Evaluation, least: float, policy: Policy) -> list[Look]:
    """Those that promise to take away what would leave the least squares: all looked at at once, then the best one step
    on.

    Beside the baseline much looks alike, for what makes a body stiffer or lighter shifts its ringing first of all: of
    those that promise a good part of it, what they promise one step on is believed.
    """
    model, found, effort = draft(fitted.model), [], policy.effort
    correction = np.zeros(0)
    for names in _apart(model):
        if problem.time_limit.is_over():
            return []
        try:
            seen = problem.evaluate(model.with_freed(*names), (*fitted.names, *names))
        except SimulationError:
            continue
        correction = fitted.residual - seen.residual
        for name in names:
            own = seen.by((*fitted.names, name))
            found.append(look_of(name, freed(model, name), own.names, fitted.residual, own.jacobian))
    removed = fitted.sum_of_squares - least
    best = most_promising(found, fitted.sum_of_squares - effort.hope * removed)[: effort.trials]
    further = one_step_on(problem, model, best, correction)
    return most_promising(further, fitted.sum_of_squares - (1 - policy.matters) * removed)


def _apart(model: Model) -> list[list[str]]:
    """Constants that may be looked at beside each other: what materials share and what is one's own change the same."""
    shared, held = shared_constants(model.description), held_constants(model)
    both = [n for n in held if n in shared], [n for n in held if n not in shared]
    return [names for names in both if names]
