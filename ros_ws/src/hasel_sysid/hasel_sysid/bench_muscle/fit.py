"""Fit what is free of a muscle to settled frames, with errors that hold where frames of one lift err alike."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sim.muscle.muscle import Muscle
from scipy.optimize import least_squares

from hasel_sysid.bench_muscle.problem import BenchProblem

_AT_BOUND = 1e-3
"""Of a parameter's range."""
_STEP = 1e-4
"""Of a parameter's size, for derivatives by differences."""


@dataclass(frozen=True)
class BenchFit:
    """muscle: with the fitted values and their standard errors; cost: mean square of the holds by the answer's scale;
    at_bound: parameters that would leave their range.
    """

    muscle: Muscle
    cost: float
    at_bound: tuple[str, ...] = ()

    def __str__(self) -> str:
        free = [str(self.muscle.parameters[name]) for name in self.muscle.free]
        text = f"{'; '.join(free) or 'nothing is free'}; off by {100 * np.sqrt(self.cost):.2g} % of the largest answer"
        return text + "".join(f"; {name} is at its bound" for name in self.at_bound)


def fit_muscle(
    problem: BenchProblem, muscle: Muscle, starts: Sequence[dict[str, float]] = (), brief: bool = False
) -> BenchFit:
    """Least squares over the free parameters within their bounds, from the muscle's values and from other starts.

    brief: a few steps and no standard errors, as for one fold of many.
    """
    if not muscle.free:
        return BenchFit(muscle, _cost(problem, muscle))
    found = [_from(problem, muscle.with_values(start), brief) for start in ({}, *starts)]
    best = min(found, key=lambda each: each.cost)
    return best if brief else with_errors(problem, best)


def _cost(problem: BenchProblem, muscle: Muscle) -> float:
    return float(np.mean(problem.per_hold(problem.residual(muscle))))


def _from(problem: BenchProblem, muscle: Muscle, brief: bool) -> BenchFit:
    names = muscle.free
    lower, upper = (
        np.array([getattr(muscle.parameters[n], end) for n in names]) for end in ("lower", "upper")
    )
    root = np.sqrt(problem.weights / problem.weights.sum())
    inner = lower + 1e-6 * (upper - lower), upper - 1e-6 * (upper - lower)

    def residual(share: np.ndarray) -> np.ndarray:
        values = dict(zip(names, lower + share * (upper - lower), strict=True))
        return root * problem.residual(muscle.with_values(values))

    start = np.clip(np.array([muscle.values[name] for name in names]), *inner)
    begin = (start - lower) / (upper - lower)
    result = least_squares(
        residual,
        begin,
        bounds=(0.0, 1.0),
        diff_step=_STEP,
        xtol=1e-9,
        ftol=1e-11,
        max_nfev=8 if brief else 60,
    )
    values = dict(zip(names, lower + result.x * (upper - lower), strict=True))
    at_bound = tuple(
        name for name, share in zip(names, result.x, strict=True) if min(share, 1 - share) < _AT_BOUND
    )
    return BenchFit(muscle.with_values(values), 2 * float(result.cost), at_bound)


def jacobian(problem: BenchProblem, muscle: Muscle, names: Sequence[str]) -> np.ndarray:
    """Derivative of the residual by parameters as shares of their ranges, [frames, names]; one-sided at a bound."""
    base = problem.residual(muscle)
    columns = []
    for name in names:
        p = muscle.parameters[name]
        step = _STEP * (p.upper - p.lower)
        step = step if p.value + step <= p.upper else -step
        moved = problem.residual(muscle.with_values({name: p.value + step}))
        columns.append((moved - base) * (p.upper - p.lower) / step)
    return np.stack(columns, axis=1) if columns else np.zeros((len(base), 0))


def with_errors(problem: BenchProblem, fit: BenchFit) -> BenchFit:
    """The fit with standard errors that take the frames of one level as one observation (clustered sandwich).

    What the zero of every run is uncertain by, all of its frames share: that is added.
    """
    names = tuple(name for name in fit.muscle.free if name not in fit.at_bound)
    slopes = jacobian(problem, fit.muscle, names)
    weighted = slopes * problem.weights[:, None]
    bread = np.linalg.pinv(slopes.T @ weighted)
    residual = problem.residual(fit.muscle)
    clusters = np.unique(problem.levels, return_inverse=True)[1]
    scores = (
        np.stack(
            [np.bincount(clusters, weighted[:, column] * residual) for column in range(len(names))], axis=1
        )
        if names
        else np.zeros((1, 0))
    )
    count = len(scores)
    spare = count / (count - len(names)) if count > len(names) else np.inf
    covariance = None
    if np.isfinite(spare):
        by_zero = bread @ weighted.T @ problem.zeros
        covariance = spare * bread @ (scores.T @ scores) @ bread + by_zero @ by_zero.T
    errors: dict[str, float | None] = dict.fromkeys(fit.muscle.free)
    for column, name in enumerate(names):
        p = fit.muscle.parameters[name]
        if covariance is not None:
            errors[name] = float(np.sqrt(max(covariance[column, column], 0.0))) * (p.upper - p.lower)
    values = {name: fit.muscle.values[name] for name in fit.muscle.free}
    return BenchFit(fit.muscle.with_values(values, errors), fit.cost, fit.at_bound)
