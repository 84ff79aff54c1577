"""The noise of a measured series from its fastest part, where the body cannot follow."""

import numpy as np

_KERNEL = np.array([1.0, -4.0, 6.0, -4.0, 1.0])
_TO_SIGMA = 1.4826


def high_frequency_noise(series: np.ndarray) -> float:
    """Standard deviation of the frame-to-frame noise in a series [n]; 0 for fewer than 8 frames.

    Fourth differences take out what moves smoothly; their median absolute value is robust against single jumps.
    Noise that is correlated from frame to frame is underestimated.
    """
    if len(series) < 8:
        return 0.0
    differences = np.convolve(series, _KERNEL, mode="valid")
    return float(_TO_SIGMA * np.median(np.abs(differences)) / np.linalg.norm(_KERNEL))
