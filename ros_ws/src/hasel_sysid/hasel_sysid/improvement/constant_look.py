"""What a constant of a model file promises from where it is, to first order, on a draft of the fitted model."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.diagnosis.step import bounded_step
from hasel_sysid.improvement.freed_constant import freed, is_possible
from hasel_sysid.problem import Problem


@dataclass(frozen=True)
class Look:
    """A constant; step: values by name, where it leads with all that was fitted; squares: expected there."""

    name: str
    step: dict[str, float]
    squares: float


def look_of(
    name: str, model: Model, names: tuple[str, ...], residual: np.ndarray, jacobian: np.ndarray
) -> Look:
    """One bounded step of the names of a model with the constant free; residual [frames], jacobian [frames, names]."""
    return Look(name, *bounded_step(model, names, residual, jacobian))


def one_step_on(problem: Problem, model: Model, looks: Sequence[Look], correction: np.ndarray) -> list[Look]:
    """Looks from where their steps lead, but for those that lead to what no model file may say or cannot be simulated.

    model: the draft; correction [frames]: of its residuals.
    """
    moved = [(look, freed(model, look.name).with_values(look.step)) for look in looks]
    possible = [
        (look.name, there, tuple(look.step)) for look, there in moved if is_possible(there, look.name)
    ]
    models, names = [there for _, there, _ in possible], [by for _, _, by in possible]
    return [
        look_of(name, there, by, seen.residual + correction, seen.jacobian)
        for (name, there, by), seen in zip(possible, problem.evaluate_each(models, names), strict=True)
        if not isinstance(seen, SimulationError)
    ]


def most_promising(looks: Sequence[Look], hoped: float) -> list[Look]:
    """Those that promise no more than so many squares, the least first."""
    return sorted((look for look in looks if look.squares <= hoped), key=lambda look: look.squares)
