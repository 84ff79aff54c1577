# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Standard errors: of the noise (sandwich), of runs that disagree (CR2), and of the discretisation (type B)."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from hasel_sim.errors import SimulationError

from hasel_sysid.noise import NoiseModel
from hasel_sysid.policy import POLICY
from hasel_sysid.problem import Evaluation, Problem

_UNSEEN = 1e-7
"""A direction of the scaled parameters with less than this share of the strongest one's response is not seen."""
_ALONE = 1e-6
_PART = 1e-3
"""Of a direction or of an estimate, from which something is part of it."""
_BEYOND_NOISE = 1.5
"""The scatter of a few runs is itself uncertain: it counts where it is this many times what the noise explains."""


@dataclass(frozen=True, eq=False)
class Directions:
    """Singular directions of the derivatives by the parameters, each parameter scaled to the same response.

    left [frames, seen]: orthonormal changes of the series; to_parameters [parameters, seen]: the change of the
    parameters behind each; undetermined [parameters]: those that an unseen direction moves.
    """

    left: np.ndarray
    to_parameters: np.ndarray
    undetermined: np.ndarray

    def estimate(self, change: np.ndarray) -> np.ndarray:
        """Least-squares change of the parameters [parameters] that follows a change of the series [frames]."""
        return self.to_parameters @ (self.left.T @ change)


def seen_directions(jacobian: np.ndarray) -> Directions:
    """Directions of derivatives [frames, parameters]."""
    size = jacobian.shape[1]
    if size == 0:
        return Directions(np.zeros((len(jacobian), 0)), np.zeros((0, 0)), np.zeros(0, dtype=bool))
    scale = np.linalg.norm(jacobian, axis=0)
    safe = np.where(scale > 0, scale, 1.0)
    left, strength, right = np.linalg.svd(jacobian / safe, full_matrices=False)
    seen = strength > _UNSEEN * strength[0] if strength[0] > 0 else np.zeros(size, dtype=bool)
    undetermined = (scale == 0) | (np.abs(right[~seen]) > _PART).any(axis=0)
    return Directions(left[:, seen], right[seen].T / strength[seen] / safe[:, None], undetermined)


def parameter_covariance(
    jacobian: np.ndarray, noise: NoiseModel, runs: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Covariance [parameters, parameters] of least-squares estimates, and which are not determined [parameters].

    H^-1 (J^T Gamma J) H^-1 with H = J^T J and Gamma the covariance of the noise within each run (the "sandwich";
    White 1980, Newey and West 1987). Entries of undetermined parameters are infinite.
    """
    seen = seen_directions(jacobian)
    middle = seen.left.T @ noise.covariance_product(seen.left, runs)
    covariance = seen.to_parameters @ middle @ seen.to_parameters.T
    covariance[seen.undetermined, :] = np.inf
    covariance[:, seen.undetermined] = np.inf
    return covariance, seen.undetermined


def wider_where_runs_disagree(
    by_noise: np.ndarray, jacobian: np.ndarray, residual: np.ndarray, runs: np.ndarray
) -> np.ndarray:
    """Standard errors [parameters], replaced by the scatter between runs where that is clearly larger.

    What a model gets wrong in each run alike is no noise, but it moves the estimates too. by_noise: standard errors
    [parameters] by noise alone.
    """
    scatter = scatter_between_runs(jacobian, residual, runs)
    return np.where(scatter > _BEYOND_NOISE * by_noise, scatter, by_noise)


def scatter_between_runs(jacobian: np.ndarray, residual: np.ndarray, runs: np.ndarray) -> np.ndarray:
    """Standard errors [parameters] of least squares at its optimum that take each run, not each frame, for one sample.

    The cluster-robust estimate CR2 (Bell and McCaffrey 2002) for the linearised problem. NaN for parameters that one
    run alone determines or none does, and for fewer runs than tell a scatter. jacobian [frames, parameters]; residual,
    runs [frames].
    """
    size = jacobian.shape[1]
    numbers = np.unique(runs)
    if size == 0 or len(numbers) < POLICY.fewest_runs:
        return np.full(size, np.nan)
    seen = seen_directions(jacobian)
    changes = [_change_by(seen.left[runs == n], residual[runs == n], seen.to_parameters) for n in numbers]
    return np.where(seen.undetermined, np.nan, np.sqrt((np.array(changes) ** 2).sum(axis=0)))


def _change_by(basis: np.ndarray, residual: np.ndarray, to_parameters: np.ndarray) -> np.ndarray:
    """What one run's residual moves the estimates by [parameters], its own pull on the fit made up for."""
    inner, share, outer = np.linalg.svd(basis, full_matrices=False)
    rest = 1 - share**2
    shared = rest > _ALONE
    pull = share[shared] / np.sqrt(rest[shared]) * (inner.T[shared] @ residual)
    change = to_parameters @ (outer[shared].T @ pull)
    alone = np.abs(to_parameters @ outer[~shared].T) > _PART * np.linalg.norm(to_parameters, axis=1)[:, None]
    change[alone.any(axis=1)] = np.nan
    return change


def changes_by_refinement(problem: Problem, base: Evaluation) -> dict[str, np.ndarray]:
    """By how much each refinement changes the simulated series [frames]; one that cannot be simulated is left out."""
    finer = problem.refinements(base.model)
    found = problem.evaluate_each(list(finer.values()), [()] * len(finer))
    return {
        name: base.residual - evaluation.residual
        for name, evaluation in zip(finer, found, strict=True)
        if not isinstance(evaluation, SimulationError)
    }


def with_numerical_error(
    evaluation: Evaluation, covariance: np.ndarray, changes: Mapping[str, np.ndarray]
) -> np.ndarray:
    """A covariance [parameters, parameters] that also holds the discretisation error: the shift of the estimates that
    each refinement would bring.

    A type B contribution: the shift, linearised, counts as one standard error (JCGM 100:2008, 4.3; ASME V&V 20-2009
    combines numerical and measurement uncertainty likewise). changes: as of `changes_by_refinement`.
    """
    seen = seen_directions(evaluation.jacobian)
    shifts = [seen.estimate(change) for change in changes.values()]
    return covariance + sum((np.outer(s, s) for s in shifts), start=np.zeros_like(covariance))
