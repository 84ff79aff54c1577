"""What a set of effects is worth: how well it foretells every run from the others."""

from dataclasses import dataclass

import numpy as np

from hasel_sysid.selection.likelihood import Whitened

_PARTS, _PIECES = 4, 16
"""Of a single run every fourth of so many pieces is left out: a body that was let go shows most of itself at first, and
what its first quarter is like no other quarter foretells."""
_FEWEST_RUNS = 4
"""Fewer do not tell how much their gains scatter."""


@dataclass(frozen=True)
class Worth:
    """densities [folds]: logarithm of the predictive density of every run left out, up to a constant that all sets of a
    likelihood share; residual [frames]: whitened, of the fit to all runs.
    """

    densities: np.ndarray
    residual: np.ndarray
    of_runs: bool

    @property
    def total(self) -> float:
        """Of all runs."""
        return float(self.densities.sum())

    def over(self, other: "Worth") -> "Gain":
        """By how much this is worth more than another set."""
        by_run = self.densities - other.densities
        count = len(by_run)
        scatter = np.sqrt(count) * by_run.std(ddof=1) if self.of_runs and count >= _FEWEST_RUNS else 0.0
        by_noise = float(np.linalg.norm(self.residual - other.residual))
        return Gain(float(by_run.sum()), float(scatter), by_noise)


@dataclass(frozen=True)
class Gain:
    """scatter: standard error by how the runs differ; by_noise: that of a log-likelihood ratio (Vuong 1989)."""

    total: float
    scatter: float
    by_noise: float

    @property
    def standard_error(self) -> float:
        """The larger: what noise explains, and what runs that disagree show."""
        return max(self.scatter, self.by_noise)


def worth(fitted: Whitened, prior_runs: float) -> Worth:
    """The leave-one-run-out log predictive density, linearised at the fit to all runs.

    prior_runs: what is known of the parameters beforehand, as the information of so many average runs.
    """
    folds = fitted.runs
    alone = len(np.unique(folds)) == 1
    if alone:
        folds = _PIECES * np.arange(len(folds)) // len(folds) % _PARTS
    numbers = np.unique(folds)
    densities = [
        _density(fitted.basis, fitted.residual, folds == fold, prior_runs / len(numbers)) for fold in numbers
    ]
    return Worth(np.array(densities), fitted.residual, not alone)


def _density(basis: np.ndarray, residual: np.ndarray, here: np.ndarray, prior: float) -> float:
    own = basis[here]
    size = own.shape[1]
    information = (1 + prior) * np.eye(size) - own.T @ own
    spread = own @ np.linalg.inv(information)
    error = residual[here] - spread @ (basis[~here].T @ residual[~here])
    # the covariance I + own information^-1 own', by its small side
    inner = np.eye(size) - own.T @ own / (1 + prior)
    _, logarithm = np.linalg.slogdet(inner)
    squares = error @ error - (own.T @ error) @ np.linalg.solve((1 + prior) * np.eye(size), own.T @ error)
    return float(0.5 * logarithm - 0.5 * squares)
