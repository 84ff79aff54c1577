"""Values that each hold until the next: what a supply was told, and when it was told otherwise."""

import numpy as np


def row_in_force(times: np.ndarray, at: np.ndarray | float) -> np.ndarray:
    """Number of the last row whose time is no later, [n]; -1 before the first.

    times [k] increase; at [n] in the same unit, or a single instant.
    """
    return np.searchsorted(times, at, side="right") - 1


def held(times: np.ndarray, values: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Value in force at every instant, [n, ...] of values [k, ...]; 0 before the first."""
    row = row_in_force(times, at)
    known = (row >= 0).reshape(-1, *[1] * (np.ndim(values) - 1))
    return np.where(known, values[np.maximum(row, 0)], 0.0)
