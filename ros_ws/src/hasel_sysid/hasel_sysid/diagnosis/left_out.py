"""How well a fitted model predicts runs that it was not fitted to, without simulating anything again."""

import numpy as np

from hasel_sysid.diagnosis.significance import orthonormal
from hasel_sysid.problem import Evaluation

_DETERMINED = 0.2
"""Share of all information about a direction that the runs but one must hold to foretell that one."""


def left_out_squares(evaluation: Evaluation) -> float:
    """Sum of squared residuals of every run when the parameters are fitted to the other runs only.

    The refit is linearised at the fit to all runs. Directions that the other runs hardly determine stay as they are: a
    run that alone tells a muscle's amplitude cannot be left out of it, and so far away derivatives say nothing.
    """
    directions = orthonormal(evaluation.jacobian)
    total = 0.0
    for run in np.unique(evaluation.runs):
        here = evaluation.runs == run
        others, residual = directions[~here], evaluation.residual
        information, axes = np.linalg.eigh(others.T @ others)
        known = information > _DETERMINED
        axes, information = axes[:, known], information[known]
        change = axes @ (axes.T @ (others.T @ residual[~here]) / information)
        left = residual[here] - directions[here] @ change
        total += float(left @ left)
    return total
