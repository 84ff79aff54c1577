"""The baseline muscle: an amplitude per voltage, approached at a limited rate (the seed paper's sloped box)."""

import numpy as np
from numba import njit
from scipy.interpolate import PchipInterpolator


def target_contraction(voltage: np.ndarray, levels: np.ndarray, amplitudes: np.ndarray) -> np.ndarray:
    """Contraction [1] aimed at for a voltage [V] of any shape, from the amplitudes at known levels [V].

    Monotone between the levels (PCHIP; Fritsch and Carlson 1980), from 0 at 0 V; above the highest level it goes on
    with the slope it has there.
    """
    if len(levels) == 0:
        return np.zeros_like(voltage, dtype=float)
    curve = PchipInterpolator(np.concatenate([[0.0], levels]), np.concatenate([[0.0], amplitudes]))
    magnitude = np.abs(voltage)
    beyond = np.maximum(magnitude - levels[-1], 0.0)
    return curve(np.minimum(magnitude, levels[-1])) + beyond * float(curve(levels[-1], 1))


@njit(cache=True)
def limit_rate(time: np.ndarray, target: np.ndarray, slope: float) -> np.ndarray:
    """Follow a target [n, 2] at times [s] [n], starting from 0, at no more than slope [1/s] up or down."""
    out = np.empty_like(target)
    for muscle in range(target.shape[1]):
        value = 0.0
        for i in range(target.shape[0]):
            reach = slope * (time[i] - time[i - 1]) if i > 0 else 0.0
            value = min(max(target[i, muscle], value - reach), value + reach)
            out[i, muscle] = value
    return out
