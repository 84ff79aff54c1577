"""Standard errors from how much the estimates depend on which runs were made."""

import numpy as np

_FEWEST_RUNS = 4
_UNSEEN = 1e-7
_ALONE = 1e-6
_BEYOND_NOISE = 1.5
"""The scatter of a few runs is itself uncertain: it counts where it is this many times what the noise explains."""


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
    run alone determines, and for fewer than four runs. jacobian [frames, parameters]; residual, runs [frames].
    """
    size = jacobian.shape[1]
    numbers = np.unique(runs)
    if size == 0 or len(numbers) < _FEWEST_RUNS:
        return np.full(size, np.nan)
    scale = np.linalg.norm(jacobian, axis=0)
    left, strength, right = np.linalg.svd(jacobian / np.where(scale > 0, scale, 1.0), full_matrices=False)
    seen = strength > _UNSEEN * strength[0] if strength[0] > 0 else np.zeros(len(strength), dtype=bool)
    to_parameters = right[seen].T / strength[seen] / np.where(scale > 0, scale, np.nan)[:, None]
    changes = [_change_by(left[runs == n][:, seen], residual[runs == n], to_parameters) for n in numbers]
    return np.sqrt((np.array(changes) ** 2).sum(axis=0))


def _change_by(basis: np.ndarray, residual: np.ndarray, to_parameters: np.ndarray) -> np.ndarray:
    """What one run's residual moves the estimates by [parameters], its own pull on the fit made up for."""
    inner, share, outer = np.linalg.svd(basis, full_matrices=False)
    rest = 1 - share**2
    shared = rest > _ALONE
    pull = share[shared] / np.sqrt(rest[shared]) * (inner.T[shared] @ residual)
    change = to_parameters @ (outer[shared].T @ pull)
    alone = np.abs(to_parameters @ outer[~shared].T) > 1e-3 * np.linalg.norm(to_parameters, axis=1)[:, None]
    change[alone.any(axis=1)] = np.nan
    return change
