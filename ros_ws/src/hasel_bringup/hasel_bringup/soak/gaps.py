"""Which frames can be compared: the simulated angle is not interpolated where states are missing."""

import numpy as np


def between_states(frames: np.ndarray, states: np.ndarray, gap: float) -> np.ndarray:
    """Whether each frame [ns] [n] lies between two states [ns] no further apart than `gap` [s]; on a state, it does."""
    after = np.clip(np.searchsorted(states, frames), 1, len(states) - 1)
    near = states[after] - states[after - 1] <= gap * 1e9
    return np.isin(frames, states) | (near & (states[after - 1] < frames) & (frames < states[after]))
