# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Bounded Gauss-Newton least squares in a trust region (Conn, Gould and Toint 2000), one step at a time.

The region is a box in units of the parameters' scales, so that a step is a linear least-squares problem within bounds.
"""

from collections.abc import Callable, Sequence

import numpy as np
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model, Parameter
from scipy.optimize import lsq_linear

from hasel_sysid.problem import Evaluation, Problem

_FIRST_RADIUS, _SMALLEST_RADIUS = 0.5, 1e-3
_POOR, _GOOD = 0.25, 0.75
"""Share of its predicted decrease below which a step shrinks the region, and above which it widens it."""
OPTIMISM = 2.0
"""Times what first order promises of the next step that a search which has not ended is given the credit of."""
MOST_STEPS = 10
"""Of one search."""
_LEAST_SCALE = 1e-3
_ROUNDS = 10
"""How often every parameter may come off a bound, at most."""
_ON, _NEAR = 1e-4, 1e-2
"""Share of a range within which a value is on a bound; share of a bound from which one more step may lead onto it."""


def bounded_change(
    residual: np.ndarray, jacobian: np.ndarray, lower: np.ndarray, upper: np.ndarray
) -> tuple[np.ndarray, float]:
    """The change of the parameters that leaves the least sum of squares, and that sum.

    residual [frames]; jacobian [frames, parameters] of the simulated series; lower, upper [parameters]: of the change.
    What nothing shows stays as it is.
    """
    scale = np.linalg.norm(jacobian, axis=0)
    seen = (scale > 1e-12) & (upper - lower > 1e-15)
    change = np.zeros(jacobian.shape[1])
    if seen.any():
        # the frames enter by their share in the columns only: few rows, of which the exact active set is quickly found
        basis, columns = np.linalg.qr(jacobian[:, seen] / scale[seen])
        bounds = lower[seen] * scale[seen], upper[seen] * scale[seen]
        most = _ROUNDS * columns.shape[1]
        solution = lsq_linear(columns, basis.T @ residual, bounds, method="bvls", max_iter=most)
        change[seen] = np.clip(solution.x / scale[seen], lower[seen], upper[seen])
    left = residual - jacobian @ change
    return change, float(left @ left)


class GaussNewton:
    """at: the best model so far, evaluated with its derivatives; predicted: sum of squares, to first order, after a
    step that only the bounds hold back; converged: whether such a step gave, or would give, next to nothing.
    """

    def __init__(self, at: Evaluation, tolerance: float, first: Sequence[str] = ()) -> None:
        """tolerance: relative decrease of the sum of squares below which a step is the last; first: parameters that
        the first step changes, all others as they are; all of them where there are none.
        """
        self.at, self.tolerance = at, tolerance
        self._radius = _FIRST_RADIUS
        self._scale = scales(at.model, at.names)
        self._propose(first)

    @property
    def names(self) -> tuple[str, ...]:
        """Of the parameters that it changes."""
        return self.at.names

    def _propose(self, only: Sequence[str] = ()) -> None:
        here = self.at
        value, lower, upper = values_and_bounds(here.model, here.names)
        reach = self._radius * self._scale * np.array([not only or name in only for name in here.names])
        down, up = np.maximum(lower - value, -reach), np.minimum(upper - value, reach)
        self._change, self._expected = bounded_change(here.residual, here.jacobian, down, up)
        _, self.predicted = bounded_change(here.residual, here.jacobian, lower - value, upper - value)
        small = here.sum_of_squares - self.predicted <= self.tolerance * here.sum_of_squares
        self.converged = bool(small or self._radius < _SMALLEST_RADIUS)

    def may_reach(self, squares: float) -> bool:
        """Whether it would come so low, were the next step worth twice what first order promises of it."""
        here = self.at.sum_of_squares
        return here - OPTIMISM * (here - self.predicted) <= squares

    def proposal(self) -> Model:
        """The model at the end of the next step."""
        values = {
            name: self.at.model.values[name] + change
            for name, change in zip(self.names, self._change, strict=True)
        }
        return self.at.model.with_values(values)

    def take(self, new: Evaluation | SimulationError) -> None:
        """Go there, where that leaves less; otherwise be more careful. new: the proposal, evaluated."""
        before, promised = self.at.sum_of_squares, self.at.sum_of_squares - self._expected
        gain = -np.inf
        if not isinstance(new, SimulationError):
            gain = before - new.sum_of_squares
            self.at = new if gain > 0 else self.at
        if gain < _POOR * promised:
            self._radius *= 0.25
        elif gain > _GOOD * promised:
            self._radius *= 3.0
        self._propose()
        # a step that gave what it promised, and that was next to nothing, is the last
        self.converged |= bool(0 < gain <= self.tolerance * before and gain >= _POOR * promised)


MayWin = Callable[[Sequence[GaussNewton]], list[bool]]
"""Which of all searches are worth another step."""


def may_be_least(searches: Sequence[GaussNewton]) -> list[bool]:
    """Those that would leave less than any does now, were the next step worth twice what first order promises."""
    least = min((s.at.sum_of_squares for s in searches), default=0.0)
    return [s.may_reach(least) for s in searches]


def best_of_each(most: int) -> MayWin:
    """Of the searches for the same parameters the one that promises most, as long as it may come among the best so many
    of different ones.
    """

    def may_win(searches: Sequence[GaussNewton]) -> list[bool]:
        best: dict[tuple[str, ...], GaussNewton] = {}
        for search in sorted(searches, key=lambda one: one.predicted):
            best.setdefault(search.names, search)
        to_beat = max(sorted(one.at.sum_of_squares for one in best.values())[:most], default=0.0)
        return [one is best[one.names] and one.may_reach(to_beat) for one in searches]

    return may_win


def step_together(problem: Problem, searches: Sequence[GaussNewton], may_win: MayWin) -> None:
    """Steps of all searches side by side, each until it has converged or, by `may_win`, is not worth another."""
    for _ in range(MOST_STEPS):
        able = may_win(searches)
        going = [s for s, worth in zip(searches, able, strict=True) if worth and not s.converged]
        if not going:
            return
        seen = problem.evaluate_each([s.proposal() for s in going], [s.names for s in going])
        for search, new in zip(going, seen, strict=True):
            search.take(new)


def minimise(problem: Problem, start: Evaluation, tolerance: float, most: int) -> tuple[Evaluation, bool]:
    """The best model within so many evaluations, and whether the search converged."""
    search, count = GaussNewton(start, tolerance), 0
    while not search.converged and count < most:
        search.take(problem.evaluate_each([search.proposal()], [search.names])[0])
        count += 1
    return search.at, search.converged


def scales(model: Model, names: Sequence[str]) -> np.ndarray:
    """By how much first order may be believed to change parameters, [names]: an effect's size by twice what one would
    notice or what it is; everything else by itself.
    """
    sizes = {f"{e.id}.{p.name}": p for e in model.effects for p in e.parameters if not p.scan}
    found = []
    for name in names:
        p = model.parameters[name]
        own = p.magnitude or _LEAST_SCALE
        if name in sizes:
            typical, null = sizes[name].typical, sizes[name].null
            own = 2 * max(abs(typical - null), abs(p.value - null))
        found.append(own)
    return np.array(found)


def values_and_bounds(model: Model, names: Sequence[str]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Values, lower and upper bounds of parameters, [names]."""
    rows = [(model.parameters[n].value, model.parameters[n].lower, model.parameters[n].upper) for n in names]
    value, lower, upper = np.reshape(rows, (-1, 3)).T.copy()
    return value, lower, upper


def at_bound(evaluation: Evaluation) -> tuple[str, ...]:
    """Names of the parameters that a fit ended on a bound of, or near one to which one more step would take them."""
    value, lower, upper = values_and_bounds(evaluation.model, evaluation.names)
    further, _ = bounded_change(evaluation.residual, evaluation.jacobian, lower - value, upper - value)
    parameters = [evaluation.model.parameters[name] for name in evaluation.names]
    ends = zip(parameters, value + further, strict=True)
    return tuple(p.name for p, end in ends if any(_held(p, bound, end) for bound in (p.lower, p.upper)))


def further_without_bounds(evaluation: Evaluation, name: str) -> float:
    """By how much one more step would move a parameter, were it not for its own bounds; the others keep theirs."""
    value, lower, upper = values_and_bounds(evaluation.model, evaluation.names)
    own = evaluation.names.index(name)
    lower[own], upper[own] = -np.inf, np.inf
    step, _ = bounded_change(evaluation.residual, evaluation.jacobian, lower - value, upper - value)
    return float(step[own])


def _held(p: Parameter, bound: float, end: float) -> bool:
    if not np.isfinite(bound):
        return False
    width = p.upper - p.lower
    on = _ON * (width if np.isfinite(width) else abs(bound) or 1.0)
    on_its_way = abs(p.value - bound) < _NEAR * abs(bound) and abs(end - bound) < on
    return bool(abs(p.value - bound) < on or on_its_way)
