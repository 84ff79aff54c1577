"""How many frames of an error count, where neighbouring frames share it."""

import numpy as np


def independent_share(error: np.ndarray, runs: np.ndarray) -> float:
    """Share of the squares of an error [frames] that are as good as independent; runs [frames].

    Of a series with the memory m of an autoregression of first order it is (1 - m^2) / (1 + m^2) (Bartlett 1946).
    """
    squares = float(error @ error)
    if squares == 0.0:
        return 1.0
    beside = runs[1:] == runs[:-1]
    memory = abs(float(error[1:][beside] @ error[:-1][beside])) / squares
    memory = min(memory, 1 - 1 / len(error))
    return (1 - memory**2) / (1 + memory**2)
