# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The one currency: the log-likelihood of residuals under one declared covariance.

Measured noise, white and shared by neighbouring frames; one slow discrepancy that no model is without (Kennedy and
O'Hagan 2001); the discretisation error of the likeliest model, in an unknown amount in every run; an offset in every
series, free where nothing tells it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numba import njit

from hasel_sysid.candidates import Candidate
from hasel_sysid.estimation.fit import FittedModel
from hasel_sysid.estimation.least_squares import further_without_bounds
from hasel_sysid.noise import LONGEST_CORRELATION, NoiseModel, allowed_noise
from hasel_sysid.policy import POLICY
from hasel_sysid.projection import orthonormal

Names = frozenset[str]
NOTHING: Names = frozenset()


@dataclass(frozen=True, eq=False)
class FittedSet:
    """The baseline with a set of candidates, fitted. candidates: by name; fit: the model."""

    candidates: dict[str, Candidate]
    fit: FittedModel

    @property
    def names(self) -> Names:
        """Of the candidates."""
        return frozenset(self.candidates)

    @property
    def has_constant(self) -> bool:
        """Whether a number of the model file is among them."""
        return any(candidate.is_constant for candidate in self.candidates.values())

    @property
    def residual(self) -> np.ndarray:
        """Measured minus simulated, [frames]."""
        return self.fit.evaluation.residual

    @cached_property
    def moving(self) -> tuple[str, ...]:
        """The fitted parameters that no bound holds."""
        return tuple(name for name in self.fit.evaluation.names if name not in self.fit.at_bound)

    @property
    def jacobian(self) -> np.ndarray:
        """Derivatives by the moving parameters, [frames, moving]."""
        return self.fit.evaluation.by(self.moving).jacobian

    @cached_property
    def plausible(self) -> bool:
        """Whether every candidate's values lie inside their ranges, a model file may say so, and each does what nothing
        else in the model does.
        """
        return all(
            c.is_possible_in(self.fit.model)
            and not out_of_range(c, self.fit)
            and not _is_a_double(c, self.fit)
            for c in self.candidates.values()
        )

    @property
    def on_edge(self) -> bool:
        """Whether a value only just lies inside, on a bound."""
        return any(on_edge(c, self.fit) for c in self.candidates.values())


def on_edge(candidate: Candidate, fit: FittedModel) -> list[str]:
    """The candidate's parameters that ended on a bound, but for what is at its null or not determined."""
    nulls = {name: p.null for name, p in candidate.sizes.items()}
    return [
        name
        for name in fit.at_bound
        if name in candidate.names
        and name not in fit.undetermined
        and not np.isclose(fit.model.values[name], nulls.get(name, np.inf), atol=1e-6)
    ]


def out_of_range(candidate: Candidate, fit: FittedModel) -> bool:
    """Whether a value would surely have to lie beyond its plausible range."""
    return any(
        abs(further_without_bounds(fit.evaluation, name))
        > POLICY.confidence * (fit.model.parameters[name].standard_error or 0.0)
        for name in on_edge(candidate, fit)
    )


def _is_a_double(candidate: Candidate, fit: FittedModel) -> bool:
    """Whether it does only what other free parameters do: such as a modulus that is free already."""
    sizes = set(candidate.sizes) & set(fit.evaluation.names)
    return bool(sizes) and sizes <= set(fit.undetermined)


@dataclass(frozen=True, eq=False)
class Whitened:
    """residual [frames]: whitened, what the parameters can still follow taken out of it (the step from least squares to
    generalised least squares); basis [frames, n]: orthonormal, what they can follow; runs, series: number of the run,
    and of its output, that each belongs to, [frames].
    """

    residual: np.ndarray
    basis: np.ndarray
    runs: np.ndarray
    series: np.ndarray

    @property
    def logarithm(self) -> float:
        """Of the likelihood at its maximum, up to a constant that all models share."""
        return -0.5 * float(self.residual @ self.residual)

    def beyond(self, columns: np.ndarray) -> np.ndarray:
        """What the parameters cannot follow of whitened columns [frames] or [frames, n]."""
        return columns - self.basis @ (self.basis.T @ columns)


class Likelihood:
    """Of the frames of several runs."""

    def __init__(
        self,
        noise: NoiseModel,
        runs: np.ndarray,
        discrepancy: float = 0.0,
        discretisation: Sequence[np.ndarray] = (),
        shared: Sequence[np.ndarray] = (),
        free_offset: bool = True,
        series: np.ndarray | None = None,
    ) -> None:
        """runs [frames]; discrepancy: rms of what no model has, as slow as noise can be; discretisation: changes
        [frames] by finer numerics, each in an unknown amount with a standard deviation of one in every
        series; shared: changes [frames] likewise, each in one amount for all runs; free_offset: whether nothing tells
        the offset of a series; series [frames]: one output of one run, which alone share noise (default: a run).
        """
        self.noise, self.runs, self.discrepancy, self._free_offset = noise, runs, discrepancy, free_offset
        self.series = runs if series is None else series
        self._changes = np.column_stack([np.zeros((len(runs), 0)), *discretisation])
        self._shared = np.column_stack([np.zeros((len(runs), 0)), *shared])

    @property
    def allowed(self) -> NoiseModel:
        """What a right model may leave: what was measured, and what no model has."""
        return allowed_noise(self.noise, self.discrepancy)

    def whiten(self, columns: np.ndarray) -> np.ndarray:
        """Columns [frames] or [frames, n] in units of independent noise of variance one, offsets taken out."""
        out = self._by_series(columns.reshape(len(columns), -1))
        directions, left = self._known_of_all
        out -= directions @ ((1 - left)[:, None] * (directions.T @ out))
        return out.reshape(columns.shape)

    def _by_series(self, columns: np.ndarray) -> np.ndarray:
        out = np.empty(columns.shape)
        for here, directions, left in self._known:
            part = self._innovations(columns[here])
            out[here] = part - directions @ ((1 - left)[:, None] * (directions.T @ part))
        return out

    def whitened(self, fitted: FittedSet) -> Whitened:
        """A fitted set."""
        return self.of(fitted.residual, fitted.jacobian)

    def of(self, residual: np.ndarray, jacobian: np.ndarray) -> Whitened:
        """A residual [frames] of a model with these derivatives [frames, n]."""
        white = self.whiten(np.column_stack([residual, jacobian]))
        basis = orthonormal(white[:, 1:])
        return Whitened(white[:, 0] - basis @ (basis.T @ white[:, 0]), basis, self.runs, self.series)

    @cached_property
    def _known_of_all(self) -> tuple[np.ndarray, np.ndarray]:
        """Directions of what all runs share, whitened, and what is left of each."""
        return _uncertain(self._by_series(self._shared))

    @cached_property
    def _known(self) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Of every series: its frames, the directions of a free offset and the discretisation, whitened, and what is
        left of each.
        """
        found = []
        for one in np.unique(self.series):
            here = self.series == one
            offset = self._innovations(np.ones((int(here.sum()), int(self._free_offset))))
            offset /= np.linalg.norm(offset, axis=0)
            changes = self._innovations(self._changes[here])
            changes = changes - offset @ (offset.T @ changes)
            directions, left = _uncertain(changes)
            left = np.concatenate([np.zeros(offset.shape[1]), left])
            found.append((here, np.column_stack([offset, directions]), left))
        return found

    def _innovations(self, columns: np.ndarray) -> np.ndarray:
        """Of the frames of one series."""
        slow = np.array([self.noise.coloured, self.discrepancy**2])
        white = max(self.noise.white, 1e-9 * float(slow.sum()))
        memory = np.array([self.noise.correlation, LONGEST_CORRELATION])
        return _filtered(np.ascontiguousarray(columns, dtype=float), white, slow, memory)


def _uncertain(changes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Directions [frames, n] of whitened changes, each in an unknown amount with a standard deviation of one, and what
    whitening leaves of each.
    """
    directions, strength, _ = np.linalg.svd(changes, full_matrices=False)
    return directions, 1 / np.sqrt(1 + strength**2)


@njit(cache=True)
def _filtered(
    columns: np.ndarray, white: float, variances: np.ndarray, correlations: np.ndarray
) -> np.ndarray:  # pragma: no cover  (compiled)
    """What no earlier frame predicts of columns [frames, n], over its standard deviation (a Kalman filter)."""
    frames, count = columns.shape
    parts = len(variances)
    out = np.empty((frames, count))
    slow = np.zeros((parts, count))
    spread = np.diag(variances)
    for frame in range(frames):
        shared = spread.sum(axis=1)
        total = shared.sum() + white
        ahead = columns[frame] - slow.sum(axis=0)
        out[frame] = ahead / np.sqrt(total)
        share = shared / total
        for i in range(parts):
            slow[i] = correlations[i] * (slow[i] + share[i] * ahead)
        for i in range(parts):
            for j in range(parts):
                left = spread[i, j] - share[i] * shared[j]
                spread[i, j] = correlations[i] * correlations[j] * left
            spread[i, i] += variances[i] * (1 - correlations[i] ** 2)
    return out
