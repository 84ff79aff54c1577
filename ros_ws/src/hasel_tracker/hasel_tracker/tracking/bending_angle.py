"""Bending angle of the body from its markers."""

import numpy as np
from hasel_recording.marker_angle import turn_between


def head_middle_tail(points: np.ndarray) -> np.ndarray:
    """The three points (3, 2) that make the angle, of markers (m, 2) in order, m at least 3.

    The middle one is half-way along the row; of an even number it is half-way between the two in the middle.
    """
    points = np.asarray(points, dtype=float)
    inner = points[(len(points) - 1) // 2 : len(points) // 2 + 1].mean(axis=0)
    return np.stack([points[0], inner, points[-1]])


def bending_angle(
    points: np.ndarray, mirrored: bool = False, rest_direction_deg: float = 0.0
) -> tuple[float, float]:
    """Return (sin θ, θ [rad]) from the markers in image axes (x right, y down).

    `points` has shape (m, 2), from head to tail, in any one unit. With v_HM from head to middle and v_MT
    from middle to tail, sin θ = cross(v_HM, v_MT) / (|v_HM| |v_MT|), taken in axes with y up so that it is
    positive when the upper muscle contracts. Of two markers v_HM is where the straight body would point,
    anticlockwise from right. `mirrored` is for a camera that looks from below or over a mirror. Markers that
    coincide or are NaN give NaN.
    """
    points = np.asarray(points, dtype=float)
    if len(points) == 2:
        turn = np.radians(rest_direction_deg)
        front, rear = np.array([np.cos(turn), -np.sin(turn)]), points[1] - points[0]
    else:
        head, middle, tail = head_middle_tail(points)
        front, rear = middle - head, tail - middle
    axes = np.array([1.0, 1.0 if mirrored else -1.0])  # the image's y axis points down
    sine, angle = turn_between(front * axes, rear * axes)
    return float(sine), float(angle)
