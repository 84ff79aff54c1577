"""Noise of the measured angle, frame by frame."""

import numpy as np


class CameraNoise:
    """White noise plus noise shared by neighbouring frames (first-order autoregressive), each as rms of sin theta.

    correlation: of the shared part, from one frame to the next.
    """

    def __init__(self, white: float, coloured: float, correlation: float, seed: int) -> None:
        self._white, self._coloured, self._correlation = white, coloured, correlation
        self._generator = np.random.default_rng(seed)
        self._shared = coloured * self._generator.standard_normal()

    def next(self) -> float:
        """The noise of the next frame."""
        white, drive = self._generator.standard_normal(2)
        noise = self._white * white + self._shared
        fresh = self._coloured * np.sqrt(1 - self._correlation**2) * drive
        self._shared = self._correlation * self._shared + fresh
        return float(noise)
