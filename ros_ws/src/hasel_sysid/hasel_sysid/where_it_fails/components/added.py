"""How much one further column explains beyond offset, gain and lag."""

import numpy as np

from hasel_sysid.where_it_fails.components.aligned import Alignment
from hasel_sysid.where_it_fails.robust_regression import Regression, regress


def explained_by(aligned: Alignment, columns: np.ndarray, frame_time: float) -> tuple[Regression, float]:
    """Regression of the remainder on further columns [n, k] and the rms of sin theta they account for.

    The coefficients of the further columns come first.
    """
    base = regress(aligned.remainder, aligned.columns, frame_time)
    both = regress(aligned.remainder, np.column_stack([columns, aligned.columns]), frame_time)
    drop = max(base.sum_of_squares - both.sum_of_squares, 0.0)
    return both, float(np.sqrt(drop / len(aligned.remainder)))
