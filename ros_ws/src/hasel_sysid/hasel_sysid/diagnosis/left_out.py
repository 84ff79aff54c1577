"""How well a fitted model predicts runs that it was not fitted to, without simulating anything again."""

import numpy as np

from hasel_sysid.problem import Evaluation


def left_out_squares(evaluation: Evaluation) -> float:
    """Sum of squared residuals of every run when the parameters are fitted to the other runs only.

    The refit is linearised at the fit to all runs. Directions that the other runs do not determine stay as they are.
    """
    total = 0.0
    for run in np.unique(evaluation.runs):
        here = evaluation.runs == run
        change, *_ = np.linalg.lstsq(evaluation.jacobian[~here], evaluation.residual[~here], rcond=1e-8)
        left = evaluation.residual[here] - evaluation.jacobian[here] @ change
        total += float(left @ left)
    return total
