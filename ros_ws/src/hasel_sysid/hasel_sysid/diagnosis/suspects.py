"""The numerics as suspects: would a finer mesh or a shorter step explain what is left?"""

from collections.abc import Mapping

import numpy as np

from hasel_sysid.estimation.result import FitResult
from hasel_sysid.projection import orthonormal


def numerical_suspects(fit: FitResult, changes: Mapping[str, np.ndarray], excess: float) -> dict[str, float]:
    """Share of the excess sum of squares that each refinement explains, once the fitted parameters have followed.

    changes: of the simulated series by each refinement [frames].
    """
    residual = fit.evaluation.residual
    basis = orthonormal(fit.evaluation.jacobian)
    shares = {}
    for name, whole in changes.items():
        change = whole - basis @ (basis.T @ whole)
        power = float(change @ change)
        amount = float(np.clip(change @ residual / power, 0.0, 1.0)) if power > 1e-20 else 0.0
        drop = 2 * amount * float(change @ residual) - amount**2 * power
        shares[name] = float(np.clip(drop / excess, 0, 1))
    return shares
