"""Standard errors from how much the estimates depend on which runs were made."""

import numpy as np

from hasel_sysid.estimation.directions import seen_directions

_FEWEST_RUNS = 4
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
    run alone determines or none does, and for fewer than four runs. jacobian [frames, parameters]; residual, runs
    [frames].
    """
    size = jacobian.shape[1]
    numbers = np.unique(runs)
    if size == 0 or len(numbers) < _FEWEST_RUNS:
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
    alone = np.abs(to_parameters @ outer[~shared].T) > 1e-3 * np.linalg.norm(to_parameters, axis=1)[:, None]
    change[alone.any(axis=1)] = np.nan
    return change
