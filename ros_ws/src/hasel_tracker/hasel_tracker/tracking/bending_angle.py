"""Bending angle of the body from the head, middle and tail markers."""

import numpy as np


def bending_angle(points: np.ndarray, mirrored: bool = False) -> tuple[float, float]:
    """Return (sin θ, θ [rad]) from the markers in image axes (x right, y down).

    `points` has shape (3, 2): head, middle, tail, in any one unit. With v_HM from head to middle and v_MT
    from middle to tail, sin θ = cross(v_HM, v_MT) / (|v_HM| |v_MT|), taken in axes with y up so that it is
    positive when the upper muscle contracts. `mirrored` is for a camera that looks from below or over a
    mirror. Markers that coincide or are NaN give NaN.
    """
    head, middle, tail = np.asarray(points, dtype=float)
    front, rear = middle - head, tail - middle
    lengths = np.hypot(*front) * np.hypot(*rear)
    if not lengths > 0.0:
        return float("nan"), float("nan")
    cross = front[1] * rear[0] - front[0] * rear[1]
    cross = -cross if mirrored else cross
    return float(cross / lengths), float(np.arctan2(cross, front @ rear))
