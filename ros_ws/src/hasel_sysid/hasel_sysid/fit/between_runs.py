"""Standard errors from how much the estimates depend on which runs were made."""

import numpy as np

_FEWEST_RUNS = 4
_UNSEEN = 1e-7
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
    """Jackknife standard errors [parameters]: least squares at its optimum, every run left out in turn.

    The cluster-robust estimate CR3 (Bell and McCaffrey 2002) for the linearised problem. NaN for parameters that the
    runs do not determine as soon as one of them is left out, and for fewer than four runs.
    jacobian [frames, parameters]; residual, runs [frames].
    """
    size = jacobian.shape[1]
    numbers = np.unique(runs)
    if size == 0 or len(numbers) < _FEWEST_RUNS:
        return np.full(size, np.nan)
    scale = np.linalg.norm(jacobian, axis=0)
    scaled = jacobian / np.where(scale > 0, scale, 1.0)
    changes = np.array([_change_without(scaled, residual, runs == run) for run in numbers])
    count = len(numbers)
    variance = (count - 1) / count * ((changes - changes.mean(axis=0)) ** 2).sum(axis=0)
    return np.sqrt(variance) / np.where(scale > 0, scale, np.nan)


def _change_without(scaled: np.ndarray, residual: np.ndarray, left_out: np.ndarray) -> np.ndarray:
    """By how much the estimates change when these frames are left out [parameters]."""
    left, strength, right = np.linalg.svd(scaled[~left_out], full_matrices=False)
    seen = strength > _UNSEEN * strength[0] if strength[0] > 0 else np.zeros(len(strength), dtype=bool)
    change = right[seen].T @ (left[:, seen].T @ residual[~left_out] / strength[seen])
    change[(np.abs(right[~seen]) > 1e-3).any(axis=0)] = np.nan
    return change
