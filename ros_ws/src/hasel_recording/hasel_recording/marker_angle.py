"""The bending angle from the three markers."""

import numpy as np


def sin_theta_from_markers(markers: np.ndarray) -> np.ndarray:
    """Return sin θ = cross(v_HM, v_MT) / (|v_HM| |v_MT|), shape [...], y up.

    markers: [..., 3, 2], head, middle, tail in any one unit; v_HM points from head to middle, v_MT from middle
    to tail. Markers that coincide give NaN.
    """
    chords = np.diff(markers, axis=-2)
    return turn_between(chords[..., 0, :], chords[..., 1, :])[0]


def turn_between(first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return (sin θ, θ [rad]) of the turn from one vector to another, both [..., 2], y up, anticlockwise positive.

    NaN where either has no length.
    """
    cross = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
    lengths = np.hypot(first[..., 0], first[..., 1]) * np.hypot(second[..., 0], second[..., 1])
    nowhere = np.full(np.shape(cross), np.nan)
    sine = np.divide(cross, lengths, out=nowhere, where=lengths > 0)
    angle = np.arctan2(cross, (first * second).sum(axis=-1))
    return sine, np.where(lengths > 0, angle, np.nan)
