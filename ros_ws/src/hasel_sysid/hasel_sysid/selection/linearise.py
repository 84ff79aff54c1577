# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What every candidate does beside one fitted model, to first order: one batch of low-fidelity simulations."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sim.errors import HaselSimError, SimulationError
from hasel_sim.model import Model

from hasel_sysid.candidates import Candidate
from hasel_sysid.estimation.starts import Screened, Start
from hasel_sysid.problem import Problem
from hasel_sysid.selection.likelihood import FittedSet

_MOST_CHANGE = 0.5
"""First order is not believed to change a parameter by more than this share, but for what is a size."""


@dataclass(frozen=True, eq=False)
class CandidateColumns:
    """A candidate beside a model, linearised at some values of its parameters.

    values: there, by name; names: of the parameters that may change; change [frames]: of the simulated series by it;
    jacobian [frames, names]: there, by its own parameters and what it makes the muscles show; lower, upper [names]: by
    how much these may change.
    """

    candidate: Candidate
    values: Mapping[str, float]
    names: tuple[str, ...]
    change: np.ndarray
    jacobian: np.ndarray
    lower: np.ndarray
    upper: np.ndarray

    @property
    def looks(self) -> np.ndarray:
        """What it can look like, size and sign left open, [frames, n]."""
        return np.column_stack([self.change, self.jacobian])


def linearise(problem: Problem, about: FittedSet, begin: Sequence[Start]) -> list[CandidateColumns]:
    """Candidates at these starts beside a fitted set; what cannot be simulated there is left out."""
    models: list[Model] = []
    able: list[Start] = []
    for start in begin:
        try:
            models.append(start.model(about.fit.model))
            able.append(start)
        except HaselSimError:
            continue
    known = set(about.fit.model.parameters)
    names = [tuple(name for name in model.free if name not in known) for model in models]
    return [
        CandidateColumns(
            start.candidate,
            {name: v for name, v in seen.model.values.items() if name not in known},
            own,
            about.residual - seen.residual,
            seen.jacobian,
            *room(seen.model, own),
        )
        for start, own, seen in zip(able, names, problem.evaluate_each(models, names), strict=True)
        if not isinstance(seen, SimulationError)
    ]


def secant(screened: Screened) -> CandidateColumns:
    """A candidate by the change that its typical size makes beside another model: all of its sizes in proportion."""
    candidate, values = screened.start.candidate, dict(screened.start.values)
    name, p = next(iter(candidate.sizes.items()))
    lower, upper = p.lower - values[name], p.upper - values[name]
    slope = screened.change / (values[name] - p.null)
    ends = np.array([lower]), np.array([upper])
    return CandidateColumns(candidate, values, (name,), screened.change, slope[:, None], *ends)


def own_columns(of: FittedSet, name: str) -> CandidateColumns:
    """A candidate of a fitted set itself, linearised where it is; without it the set leaves `change` more."""
    candidate, evaluation = of.candidates[name], of.fit.evaluation
    own = tuple(n for n in of.moving if n in candidate.names)
    change = np.zeros(len(evaluation.residual))
    for path, p in candidate.sizes.items():
        if path in evaluation.names:
            slope = evaluation.jacobian[:, evaluation.names.index(path)]
            change += slope * (evaluation.model.values[path] - p.null)
    model = of.fit.model
    values = {n: model.values[n] for n in own}
    return CandidateColumns(candidate, values, own, change, evaluation.by(own).jacobian, *room(model, own))


def room(model: Model, names: Sequence[str]) -> tuple[np.ndarray, np.ndarray]:
    """By how much first order may change parameters [names], down and up: within their ranges, and by a share of their
    value what is no size of an effect.
    """
    sizes = {f"{e.id}.{p.name}" for e in model.effects for p in e.parameters if not p.scan}
    parameters = [model.parameters[name] for name in names]
    value, lower, upper = np.reshape([(p.value, p.lower, p.upper) for p in parameters], (-1, 3)).T
    reach = _MOST_CHANGE * np.array([np.inf if p.name in sizes else p.magnitude for p in parameters])
    return np.maximum(lower - value, -reach), np.minimum(upper - value, reach)
