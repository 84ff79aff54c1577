"""Projections onto the span of columns."""

import numpy as np


def orthonormal(columns: np.ndarray) -> np.ndarray:
    """An orthonormal basis of the span of columns [frames, n]."""
    if columns.shape[1] == 0:
        return columns
    scale = np.linalg.norm(columns, axis=0)
    left, strength, _ = np.linalg.svd(columns[:, scale > 0] / scale[scale > 0], full_matrices=False)
    return left[:, strength > 1e-8 * strength[0]] if len(strength) else left


def drops(columns: np.ndarray, basis: np.ndarray, residual: np.ndarray) -> np.ndarray:
    """By how much columns [frames, n] lower a residual's sum of squares beyond what a basis [frames, m] already does.

    residual [frames] or [frames, draws]; returns one drop for each, [] or [draws].
    """
    directions = orthonormal(columns - basis @ (basis.T @ columns))
    return ((directions.T @ residual) ** 2).sum(axis=0)
