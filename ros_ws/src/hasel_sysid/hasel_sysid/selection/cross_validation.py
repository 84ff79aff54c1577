# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""How well a model predicts every run from the others: elpd, its differences and their errors.

Leave-one-run-out log predictive density (Vehtari, Gelman and Gabry 2017), linearised at the fit to all runs.
"""

from dataclasses import dataclass

import numpy as np

from hasel_sysid.policy import POLICY
from hasel_sysid.selection.likelihood import Whitened

_PARTS, _PIECES = 4, 16
"""Of a single run every fourth of so many pieces is left out: a body that was let go shows most of itself at first, and
what its first quarter is like no other quarter predicts."""
_TINY = float(np.finfo(float).tiny)


@dataclass(frozen=True, eq=False)
class Elpd:
    """densities [folds]: logarithm of the predictive density of every run left out, up to a constant that all models
    share; residual [frames]: whitened, of the fit to all runs; powers [folds]: of what was measured; None where the
    folds are no runs.
    """

    densities: np.ndarray
    residual: np.ndarray
    powers: np.ndarray | None

    @property
    def total(self) -> float:
        """Of all runs."""
        return float(self.densities.sum())

    def over(self, other: "Elpd") -> "Difference":
        """By how much this model predicts better than another."""
        by_run = self.densities - other.densities
        powers = None if len(by_run) < POLICY.fewest_runs else self.powers
        by_noise = float(np.linalg.norm(self.residual - other.residual))
        error = by_noise if powers is None else max(_scatter(by_run, powers), by_noise)
        return Difference(
            float(by_run.sum()), error, by_noise, powers is not None and bool((by_run > 0).all())
        )


@dataclass(frozen=True)
class Difference:
    """Of two elpd. error: standard error, of runs that disagree, and no less than by_noise: what noise alone makes of a
    log-likelihood ratio (Vuong 1989). in_every_run: whether enough runs were left out, and all are predicted better.
    """

    total: float
    error: float
    by_noise: float
    in_every_run: bool

    def exceeds(self, standard_errors: float) -> bool:
        """Whether it is larger than so many standard errors, or than those by noise where no run disagrees.

        Of few runs one may gain so much more than the others that the scatter exceeds the sum; that all of four gain by
        chance is less likely (sign test, one in sixteen) than that one standard error is exceeded.
        """
        return self.total > standard_errors * (self.by_noise if self.in_every_run else self.error)


def _scatter(gains: np.ndarray, powers: np.ndarray) -> float:
    """Standard error of the sum of gains [runs] that grow with the power of what was measured [runs].

    That a run in which the body hardly moves tells little is no disagreement: every run is compared with its share of
    the sum (the ratio estimator's v_D of Royall and Cumberland 1981). Of runs of one power it is the usual one.
    """
    share = powers / max(powers.sum(), _TINY)
    away = gains - share * gains.sum()
    return float(np.sqrt((away**2 / np.maximum(1 - share, _TINY)).sum()))


def leave_one_run_out(fitted: Whitened, measured: np.ndarray, prior_runs: float) -> Elpd:
    """measured [frames]: the series itself, the mean of every run removed; prior_runs: what is known of the parameters
    beforehand, as the information of so many average runs.
    """
    folds = fitted.runs
    alone = len(np.unique(folds)) == 1
    if alone:
        folds = np.concatenate([_pieces(int(count)) for count in np.bincount(fitted.series)])
    numbers = np.unique(folds)
    densities = [
        _density(fitted.basis, fitted.residual, folds == fold, prior_runs / len(numbers)) for fold in numbers
    ]
    powers = None if alone else np.array([(measured[folds == fold] ** 2).sum() for fold in numbers])
    return Elpd(np.array(densities), fitted.residual, powers)


def _pieces(frames: int) -> np.ndarray:
    """Number of the fold of each frame of a series."""
    return _PIECES * np.arange(frames) // frames % _PARTS if frames else np.zeros(0, dtype=int)


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
