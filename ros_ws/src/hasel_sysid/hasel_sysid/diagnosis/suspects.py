"""The numerics as suspects: would a finer mesh or a shorter step explain what is left?"""

import numpy as np
from hasel_sim.errors import SimulationError

from hasel_sysid.diagnosis.significance import orthonormal
from hasel_sysid.fit.result import FitResult
from hasel_sysid.problem import Problem


def numerical_suspects(problem: Problem, fit: FitResult, excess: float) -> dict[str, float]:
    """Share of the excess sum of squares that each refinement explains, once the fitted parameters have followed."""
    numerics = fit.model.description.numerics
    finer = {
        "mesh": fit.model.with_numerics(mesh_density=1.5 * numerics.mesh_density, quadrature_order=2),
        "time_step": fit.model.with_numerics(steps_per_second=2 * numerics.steps_per_second),
    }
    base = fit.evaluation
    basis = orthonormal(base.jacobian)
    shares = {}
    for name, found in zip(
        finer, problem.evaluate_each(list(finer.values()), [()] * len(finer)), strict=True
    ):
        if isinstance(found, SimulationError):
            continue
        change = base.residual - found.residual
        change -= basis @ (basis.T @ change)
        power = float(change @ change)
        amount = float(np.clip(change @ base.residual / power, 0.0, 1.0)) if power > 1e-20 else 0.0
        drop = 2 * amount * float(change @ base.residual) - amount**2 * power
        shares[name] = float(np.clip(drop / excess, 0, 1))
    return shares
