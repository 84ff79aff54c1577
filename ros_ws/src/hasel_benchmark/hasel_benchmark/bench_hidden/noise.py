"""Measurement noise of the angle: white, or shared by neighbouring frames."""

import numpy as np
from scipy.signal import lfilter

NOISE_RMS = 0.003
"""Of sin theta, as on the rig."""
COLOURS = {"white": 0.0, "coloured": 0.9}
"""Correlation of neighbouring frames (first-order autoregressive)."""
_OFFSET_RMS = 0.005
"""How far the camera stands turned from run to run [sin theta]."""


def draw_noise(frames: int, colour: str, generator: np.random.Generator) -> np.ndarray:
    """Stationary noise of sin theta, [frames]."""
    correlation = COLOURS[colour]
    drive = generator.standard_normal(frames)
    drive[1:] *= np.sqrt(1 - correlation**2)
    return NOISE_RMS * lfilter([1.0], [1.0, -correlation], drive)


def draw_offset(generator: np.random.Generator) -> float:
    """What one run's zero is off [sin theta]."""
    return float(_OFFSET_RMS * generator.standard_normal())
