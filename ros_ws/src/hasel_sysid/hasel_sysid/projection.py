"""Projections onto the span of columns."""

import numpy as np


def orthonormal(columns: np.ndarray) -> np.ndarray:
    """An orthonormal basis of the span of columns [frames, n]."""
    if columns.shape[1] == 0:
        return columns
    scale = np.linalg.norm(columns, axis=0)
    left, strength, _ = np.linalg.svd(columns[:, scale > 0] / scale[scale > 0], full_matrices=False)
    return left[:, strength > 1e-8 * strength[0]] if len(strength) else left
