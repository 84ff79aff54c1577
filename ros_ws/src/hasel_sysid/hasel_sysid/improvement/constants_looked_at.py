"""What constants of a model file promise, on a draft of the fitted model: all at once, then the best one step on."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from hasel_sim.errors import ModelError, SimulationError
from hasel_sim.model import Model
from hasel_sim.model.constants import constants, shared_constants

from hasel_sysid.diagnosis.step import bounded_step
from hasel_sysid.draft import draft
from hasel_sysid.policy import Policy
from hasel_sysid.problem import Evaluation, Problem

_RANGE = 0.3, 3.0
"""How far a constant may be from what the file says, as the scale of a modulus may."""


@dataclass(frozen=True)
class _Look:
    """A constant; step: where a bounded step of it, and of all that was fitted, leads; squares: expected there."""

    name: str
    step: dict[str, float]
    squares: float


def looked_at(problem: Problem, fitted: Evaluation, least: float, policy: Policy) -> list[str]:
    """The constants from which a fit promises to take away what would leave the least squares, most promising first.

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
            found.append(_look(name, freed(model, name), own.names, fitted.residual, own.jacobian))
    removed = fitted.sum_of_squares - least
    best = _most_promising(found, fitted.sum_of_squares - effort.hope * removed)[: effort.trials]
    further = _one_step_on(problem, model, best, correction)
    promising = _most_promising(further, fitted.sum_of_squares - (1 - policy.matters) * removed)
    return [look.name for look in promising[: effort.fits]]


def _most_promising(looks: Sequence[_Look], hoped: float) -> list[_Look]:
    return sorted((look for look in looks if look.squares <= hoped), key=lambda look: look.squares)


def _one_step_on(
    problem: Problem, model: Model, looks: Sequence[_Look], correction: np.ndarray
) -> list[_Look]:
    """Looks from where their steps lead, but for those that lead to what no model file may say."""
    moved = [(look, freed(model, look.name).with_values(look.step)) for look in looks]
    possible = [
        (look.name, there, tuple(look.step)) for look, there in moved if is_possible(there, look.name)
    ]
    models, names = [there for _, there, _ in possible], [by for _, _, by in possible]
    return [
        _look(name, there, by, seen.residual + correction, seen.jacobian)
        for (name, there, by), seen in zip(possible, problem.evaluate_each(models, names), strict=True)
        if not isinstance(seen, SimulationError)
    ]


def is_possible(model: Model, name: str) -> bool:
    """Whether a file may say what a model has for a constant."""
    try:
        model.with_constants_settled(name)
    except ModelError:
        return False
    return True


def _apart(model: Model) -> list[list[str]]:
    """Constants that may be looked at beside each other: what materials share and what is one's own change the same."""
    shared = shared_constants(model.description)
    known = [n for n, value in constants(model.description).items() if value and n not in model.parameters]
    both = [n for n in known if n in shared], [n for n in known if n not in shared]
    return [names for names in both if names]


def _look(
    name: str, model: Model, names: tuple[str, ...], residual: np.ndarray, jacobian: np.ndarray
) -> _Look:
    return _Look(name, *bounded_step(model, names, residual, jacobian))


def freed(model: Model, name: str) -> Model:
    """The model with a constant free within its range."""
    out = model.with_freed(name)
    p = out.parameters[name]
    ends = sorted(share * p.value for share in _RANGE)
    return replace(out, parameters={**out.parameters, name: replace(p, lower=ends[0], upper=ends[1])})
