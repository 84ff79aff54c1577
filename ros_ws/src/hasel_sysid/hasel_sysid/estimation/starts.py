# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where a fit begins: a typical size and the decades of the plausible range, at every time and place (multi-start)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from hasel_sim.effects.base import EffectParameter
from hasel_sim.errors import HaselSimError, SimulationError
from hasel_sim.model import Model

from hasel_sysid.candidates import Candidate
from hasel_sysid.problem import Evaluation, Problem
from hasel_sysid.projection import orthonormal

MOST_FOLLOWED = 12
"""Starts that are gone on from at most, the most promising of all that were screened."""
_LEAST, _MOST = 0.1, 2.0
"""Multiples of a start between which its change is taken to be in proportion, and not lost beside what is not."""
_FACTOR = np.sqrt(10.0)


@dataclass(frozen=True, eq=False)
class Start:
    """values: of a candidate's parameters, by name in a model; factor: of the typical size; place: the times and places
    among the values.
    """

    candidate: Candidate
    values: Mapping[str, float]
    factor: float
    place: tuple[float, ...] = ()

    @property
    def typical(self) -> bool:
        """Whether its sizes are the typical ones."""
        return self.factor == 1.0

    def model(self, beside: Model) -> Model:
        """The model with the candidate at this start. Raises ModelError where it does not fit in."""
        return self.candidate.added_to(beside).with_values(dict(self.values))

    def times(self, amount: float) -> "Start":
        """The same with its sizes so many times as far from their nulls, as far as their ranges allow."""
        sizes = {
            name: float(np.clip(p.null + amount * (self.values[name] - p.null), p.lower, p.upper))
            for name, p in self.candidate.sizes.items()
            if name in self.values
        }
        return replace(self, values={**self.values, **sizes}, factor=amount * self.factor)

    def where_it_explains(self, amount: float) -> "Start":
        """The same where that many times of it would be wanted in proportion, as far as that can be said of it."""
        size = float(np.clip(abs(amount), _LEAST, _MOST))
        return self.times(-size if amount < 0 and self.candidate.is_signed else size)


def starts(candidate: Candidate) -> list[Start]:
    """All starts of a candidate; those of typical size come first."""
    sizes, coordinates = candidate.sizes, candidate.coordinates
    places: list[dict[str, float]] = [{}]
    for name, p in coordinates.items():
        scan = sorted({*p.scan, *_between(p.scan)}) if candidate.acts_at_a_place else p.scan
        places = [{**place, name: value} for place in places for value in scan]
    first = next(iter(sizes.values()), None)
    factors = [1.0] if first is None else [1.0, *_factors(first)]
    return [
        Start(candidate, {**_at(sizes, factor), **place}, factor, tuple(place.values()))
        for factor in factors
        for place in places
    ]


def _between(scan: Sequence[float]) -> list[float]:
    """Half way from one value to the next: a body that hardly moves at one place has a valley on either side."""
    return [0.5 * (one + other) for one, other in zip(scan, scan[1:], strict=False)]


def _at(sizes: Mapping[str, EffectParameter], factor: float) -> dict[str, float]:
    return {
        name: float(np.clip(p.null + factor * (p.typical - p.null), p.lower, p.upper))
        for name, p in sizes.items()
    }


def _factors(p: EffectParameter) -> list[float]:
    """Multiples of the typical size over the plausible range: of a ratio evenly in its logarithm, else by sqrt(10) from
    a tenth of the typical size outwards, to either side of the null that the range has.
    """
    step = p.typical - p.null
    if step == 0 or not np.isfinite([p.lower, p.upper]).all():
        return []
    if p.null > 0 and p.lower > 0:
        return [float((value - p.null) / step) for value in np.geomspace(p.lower, p.upper, 7)[1:-1]]
    found, ends = [], ((p.lower - p.null) / step, (p.upper - p.null) / step)
    for side, end in ((-1.0, min(ends)), (1.0, max(ends))):
        factor = 0.1
        while factor < side * end:
            if side < 0 or not np.isclose(factor, 1.0):
                found.append(side * factor)
            factor *= _FACTOR
    return found


@dataclass(frozen=True, eq=False)
class Screened:
    """A start, simulated once. change [frames]: of the simulated series by it; amount: by how many times that the sum
    of squares is least, everything fitted followed to first order; predicted: the sum of squares there; strength: sum
    of squares of the change over that of what is to be explained.
    """

    start: Start
    change: np.ndarray
    amount: float
    predicted: float
    strength: float

    def values(self) -> dict[str, float]:
        """Of the candidate where a search from here begins: a typical size times what is best by first order, as far
        as its range allows, or as it is where that is nothing; another size as it is.
        """
        amount = self.amount if self.start.typical and self.amount else 1.0
        return dict(self.start.times(amount).values)


def screen(problem: Problem, about: Evaluation, every: Sequence[Start]) -> list[Screened]:
    """Starts beside a model, each simulated once without derivatives; what cannot be simulated is left out."""
    models, able = [], []
    for start in every:
        try:
            models.append(start.model(about.model))
            able.append(start)
        except HaselSimError:
            continue
    found = problem.evaluate_each(models, [()] * len(models))
    basis = orthonormal(about.jacobian)
    return [
        _screened(start, about.residual, basis, about.residual - seen.residual)
        for start, seen in zip(able, found, strict=True)
        if not isinstance(seen, SimulationError)
    ]


def _screened(start: Start, residual: np.ndarray, basis: np.ndarray, change: np.ndarray) -> Screened:
    left = residual - basis @ (basis.T @ residual)
    own = change - basis @ (basis.T @ change)
    power = float(own @ own)
    amount = 0.0
    if power > 0:
        amount = float(np.clip(own @ left / power, -_MOST if start.candidate.is_signed else 0.0, _MOST))
    beyond = left - amount * own
    strength = float(change @ change) / max(float(residual @ residual), 1e-300)
    return Screened(start, change, amount, float(beyond @ beyond), strength)
