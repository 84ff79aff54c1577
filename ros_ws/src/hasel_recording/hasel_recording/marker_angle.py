"""The bending angle from the three markers."""

import numpy as np


def sin_theta_from_markers(markers: np.ndarray) -> np.ndarray:
    """Return sin θ = cross(v_HM, v_MT) / (|v_HM| |v_MT|), shape [n], y up.

    markers: [n, 3, 2], head, middle, tail in any one unit; v_HM points from head to middle, v_MT from middle
    to tail. Markers that coincide give NaN.
    """
    first = markers[:, 1] - markers[:, 0]
    second = markers[:, 2] - markers[:, 1]
    cross = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    lengths = np.hypot(*first.T) * np.hypot(*second.T)
    return np.divide(cross, lengths, out=np.full(len(markers), np.nan), where=lengths > 0)
