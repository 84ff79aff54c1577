"""What a set of effects is worth: how well it foretells every run from the others."""

from dataclasses import dataclass

import numpy as np

from hasel_sysid.selection.likelihood import Whitened

_PARTS, _PIECES = 4, 16
"""Of a single run every fourth of so many pieces is left out: a body that was let go shows most of itself at first, and
what its first quarter is like no other quarter foretells."""
_FEWEST_RUNS = 4
"""Fewer do not tell how much their gains scatter."""
_TINY = float(np.finfo(float).tiny)
"""For runs in which nothing moves, or only one does."""


@dataclass(frozen=True)
class Worth:
    """densities [folds]: logarithm of the predictive density of every run left out, up to a constant that all sets of a
    likelihood share; residual [frames]: whitened, of the fit to all runs; powers [folds]: of what was measured; None
    where the folds are no runs.
    """

    densities: np.ndarray
    residual: np.ndarray
    powers: np.ndarray | None

    @property
    def total(self) -> float:
        """Of all runs."""
        return float(self.densities.sum())

    def over(self, other: "Worth") -> "Gain":
        """By how much this is worth more than another set."""
        by_run = self.densities - other.densities
        scatter = 0.0 if self.powers is None or len(by_run) < _FEWEST_RUNS else _scatter(by_run, self.powers)
        by_noise = float(np.linalg.norm(self.residual - other.residual))
        return Gain(float(by_run.sum()), scatter, by_noise)


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


def _scatter(gains: np.ndarray, powers: np.ndarray) -> float:
    """Standard error of the sum of gains [runs] that grow with the power of what was measured [runs].

    That a run in which the body hardly moves tells little is no disagreement, so that every run is compared with its
    share of the sum: the ratio estimator, its residuals corrected for what each of them had a part in (v_D of Royall
    and Cumberland 1981). Of runs of one power it is the usual standard error.
    """
    share = powers / max(powers.sum(), _TINY)
    away = gains - share * gains.sum()
    return float(np.sqrt((away**2 / np.maximum(1 - share, _TINY)).sum()))


def worth(fitted: Whitened, measured: np.ndarray, prior_runs: float) -> Worth:
    """The leave-one-run-out log predictive density, linearised at the fit to all runs.

    measured [frames]: the series itself, the mean of every run removed; prior_runs: what is known of the parameters
    beforehand, as the information of so many average runs.
    """
    folds = fitted.runs
    alone = len(np.unique(folds)) == 1
    if alone:
        folds = _PIECES * np.arange(len(folds)) // len(folds) % _PARTS
    numbers = np.unique(folds)
    densities = [
        _density(fitted.basis, fitted.residual, folds == fold, prior_runs / len(numbers)) for fold in numbers
    ]
    powers = None if alone else np.array([(measured[folds == fold] ** 2).sum() for fold in numbers])
    return Worth(np.array(densities), fitted.residual, powers)


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
