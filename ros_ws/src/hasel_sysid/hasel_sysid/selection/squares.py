"""How surely the squares of one error are larger than another's, where neighbouring frames share an error."""

import math

import numpy as np


def surely_larger(error: np.ndarray, than: np.ndarray, runs: np.ndarray) -> float:
    """By how many standard errors the logarithm of a sum of squares is the larger; errors and runs: [frames].

    A sum of d independent squares has a relative variance of 2 / d; of a series with the memory m of an autoregression
    of first order, n (1 - m^2) / (1 + m^2) squares count as independent (Bartlett 1946).
    """
    squares, others = float(error @ error), float(than @ than)
    if squares <= 0.0 or others <= 0.0:
        return math.inf if squares > others else 0.0
    variance = 2 / _independent(error, runs) + 2 / _independent(than, runs)
    return math.log(squares / others) / math.sqrt(variance)


def _independent(series: np.ndarray, runs: np.ndarray) -> float:
    beside = runs[1:] == runs[:-1]
    memory = float(series[1:][beside] @ series[:-1][beside] / (series @ series))
    memory = min(abs(memory), 1 - 1 / len(series))
    return len(series) * (1 - memory**2) / (1 + memory**2)
