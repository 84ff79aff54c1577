"""Sums of squares: beyond what every model is known to miss, and how surely one is larger than another."""

import math

import numpy as np

from hasel_sysid.estimation.bounded import bounded_change
from hasel_sysid.estimation.independent import independent_share

_MOST = 0.5


def squares_beyond_slack(residual: np.ndarray, runs: np.ndarray, slack: np.ndarray, most: float) -> float:
    """Sum of squares of a residual [frames] that the errors which every set is known to make cannot take away.

    runs [frames]; slack [frames, n]: these errors, each in its own amount in every run, of which `most` is the largest.
    """
    total, reach = 0.0, np.full(slack.shape[1], most)
    for run in np.unique(runs):
        here = runs == run
        total += bounded_change(residual[here], slack[here], -reach, reach)[1]
    return total


def squares_judge(beyond_noise: float) -> bool:
    """Whether noise does not judge: where most of what the best set leaves is more than noise explains."""
    return beyond_noise > _MOST


def surely_larger(error: np.ndarray, than: np.ndarray, runs: np.ndarray) -> float:
    """By how many standard errors the logarithm of a sum of squares is the larger; errors and runs: [frames].

    Neighbouring frames may share an error.
    """
    (one, its_error), (other, others_error) = (log_squares(e, runs) for e in (error, than))
    return 0.0 if one == other else (one - other) / math.hypot(its_error, others_error)


def log_squares(error: np.ndarray, runs: np.ndarray) -> tuple[float, float]:
    """Logarithm of a sum of squares, and its standard error.

    A sum of d independent squares has a relative variance of 2 / d.
    """
    squares = float(error @ error)
    if squares == 0.0:
        return -math.inf, 1.0
    return math.log(squares), math.sqrt(2 / (len(error) * independent_share(error, runs)))
