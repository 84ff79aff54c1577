"""Least squares of a linearised problem within bounds."""

import numpy as np
from scipy.optimize import lsq_linear

_ROUNDS = 10
"""How often every parameter may come off a bound, at most."""


def bounded_change(
    residual: np.ndarray, jacobian: np.ndarray, lower: np.ndarray, upper: np.ndarray
) -> tuple[np.ndarray, float]:
    """The change of the parameters that leaves the least sum of squares, and that sum.

    residual [frames]; jacobian [frames, parameters] of the simulated series; lower, upper [parameters]: of the change.
    What nothing shows stays as it is.
    """
    scale = np.linalg.norm(jacobian, axis=0)
    seen = (scale > 1e-12) & (upper - lower > 1e-15)
    change = np.zeros(jacobian.shape[1])
    if seen.any():
        # the frames enter by their share in the columns only: few rows, of which the exact active set is quickly found
        basis, columns = np.linalg.qr(jacobian[:, seen] / scale[seen])
        bounds = lower[seen] * scale[seen], upper[seen] * scale[seen]
        most = _ROUNDS * columns.shape[1]
        solution = lsq_linear(columns, basis.T @ residual, bounds, method="bvls", max_iter=most)
        change[seen] = np.clip(solution.x / scale[seen], lower[seen], upper[seen])
    left = residual - jacobian @ change
    return change, float(left @ left)
