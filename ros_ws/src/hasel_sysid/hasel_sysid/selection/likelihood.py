"""The currency: logarithms of the likelihood of whitened residuals."""

from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np
from numba import njit

from hasel_sysid.estimation.bounded import bounded_change
from hasel_sysid.noise import LONGEST_CORRELATION, NoiseModel
from hasel_sysid.projection import orthonormal
from hasel_sysid.selection.sets import FittedSet, Prospect
from hasel_sysid.selection.squares import squares_beyond_slack


@dataclass(frozen=True)
class Whitened:
    """residual [frames]: whitened, what the parameters can still follow taken out of it (the step from least squares to
    generalised least squares); basis [frames, n]: orthonormal, what they can follow; runs [frames].
    """

    residual: np.ndarray
    basis: np.ndarray
    runs: np.ndarray

    @property
    def logarithm(self) -> float:
        """Of the likelihood at its maximum, up to a constant that all sets share."""
        return -0.5 * float(self.residual @ self.residual)


class Likelihood:
    """Of frames whose noise is white and partly shared by neighbours, with an unknown offset in every run."""

    def __init__(
        self,
        noise: NoiseModel,
        runs: np.ndarray,
        discrepancy: float = 0.0,
        slack: np.ndarray | None = None,
        misfit: float = 0.0,
    ) -> None:
        """runs [frames]; discrepancy: rms of what no model has, as slow as noise can be; slack [frames, n]: changes
        that are in the error of every run, each in an unknown amount with a standard deviation of one; misfit: variance
        of what is still missing from the models that are compared, of which nothing else is known.
        """
        self.noise, self.runs, self.discrepancy, self.misfit = noise, runs, discrepancy, misfit
        self._slack = np.zeros((len(runs), 0)) if slack is None else slack
        self._promised: WeakKeyDictionary[Prospect, float] = WeakKeyDictionary()

    def whiten(self, columns: np.ndarray) -> np.ndarray:
        """Columns [frames] or [frames, n] in units of independent noise of variance one, offsets taken out."""
        many = columns.reshape(len(columns), -1)
        out = np.empty(many.shape)
        for here, directions, left in self._known:
            part = self._innovations(many[here])
            out[here] = part - directions @ ((1 - left)[:, None] * (directions.T @ part))
        return out.reshape(columns.shape)

    @cached_property
    def _known(self) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Of every run: its frames, the directions of offset and slack, whitened, and what is left of each."""
        found = []
        for run in np.unique(self.runs):
            here = self.runs == run
            offset = self._innovations(np.ones((int(here.sum()), 1)))
            offset /= np.linalg.norm(offset)
            slack = self._innovations(self._slack[here])
            slack = slack - offset @ (offset.T @ slack)
            directions, strength, _ = np.linalg.svd(slack, full_matrices=False)
            left = np.concatenate([[0.0], 1 / np.sqrt(1 + strength**2)])
            found.append((here, np.column_stack([offset, directions]), left))
        return found

    def _innovations(self, columns: np.ndarray) -> np.ndarray:
        """Of the frames of one run."""
        slow = np.array([self.noise.coloured, self.discrepancy**2])
        white = max(self.noise.white + self.misfit, 1e-9 * float(slow.sum()))
        memory = np.array([self.noise.correlation, LONGEST_CORRELATION])
        return _filtered(np.ascontiguousarray(columns, dtype=float), white, slow, memory)

    def whitened(self, fitted: FittedSet) -> Whitened:
        """A fitted set."""
        white = self.whiten(np.column_stack([fitted.residual, fitted.jacobian]))
        residual, basis = white[:, 0], orthonormal(white[:, 1:])
        return Whitened(residual - basis @ (basis.T @ residual), basis, self.runs)

    def squares_beyond_slack(self, residual: np.ndarray, most: float) -> float:
        """Sum of squares of a residual [frames] that the errors which every set is known to make cannot take away.

        most: standard deviations of their amount in a run.
        """
        return squares_beyond_slack(residual, self.runs, self._slack, most)

    def promised(self, prospect: Prospect) -> float:
        """Logarithm of the likelihood, up to the same constant, one bounded step on from where a prospect is."""
        if prospect not in self._promised:
            white = self.whiten(np.column_stack([prospect.residual, prospect.jacobian]))
            _, squares = bounded_change(white[:, 0], white[:, 1:], prospect.lower, prospect.upper)
            self._promised[prospect] = -0.5 * squares
        return self._promised[prospect]

    def likeness(self, one: np.ndarray, other: np.ndarray) -> float:
        """Cosine of the angle between what two effects can look like [frames, n], 0 to 1."""
        looks = [orthonormal(self.whiten(columns)) for columns in (one, other)]
        return float(np.linalg.norm(looks[0].T @ looks[1], 2))

    def gains(self, fitted: Whitened, looks: Collection[np.ndarray]) -> list["Look"]:
        """What effects that look like this [frames, n] could gain beside a fitted set."""
        return [Look(_beside(fitted, self.whiten(columns)), fitted.residual) for columns in looks]


@dataclass(frozen=True)
class Look:
    """directions [frames, n]: orthonormal, what an effect does and the fitted parameters cannot; residual: whitened."""

    directions: np.ndarray
    residual: np.ndarray

    @property
    def gain(self) -> float:
        """Of the logarithm of the likelihood, its size and sign left open."""
        return float(self.by(self.residual[:, None])[0])

    def by(self, residuals: np.ndarray) -> np.ndarray:
        """The same of other residuals [frames, draws]: [draws]."""
        return 0.5 * ((self.directions.T @ residuals) ** 2).sum(axis=0)


def _beside(fitted: Whitened, columns: np.ndarray) -> np.ndarray:
    size = np.linalg.norm(columns, axis=0)
    left = columns - fitted.basis @ (fitted.basis.T @ columns)
    seen = np.linalg.norm(left, axis=0) > 1e-6 * np.where(size > 0, size, 1.0)
    return orthonormal(left[:, seen])


@njit(cache=True)
def _filtered(columns, white, variances, correlations):  # pragma: no cover  (compiled)
    """What no earlier frame foretells of columns [frames, n], over its standard deviation (a Kalman filter)."""
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
