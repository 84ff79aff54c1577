"""What the model's own mesh and time step do to fitted values."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.fit.result import FitResult
from hasel_sysid.problem import Evaluation, Problem

_UNSEEN = 1e-7
"""As for the errors by noise: directions with less than this share of the strongest response are not seen."""


def refinements(model: Model) -> dict[str, Model]:
    """The model on a finer mesh, and with shorter time steps."""
    numerics = model.description.numerics
    return {
        "mesh": model.with_numerics(mesh_density=1.5 * numerics.mesh_density),
        "time_step": model.with_numerics(steps_per_second=2 * numerics.steps_per_second),
    }


def changes_by_refinement(problem: Problem, base: Evaluation) -> dict[str, np.ndarray]:
    """By how much each refinement changes the simulated series [frames]; one that cannot be simulated is left out."""
    finer = refinements(base.model)
    found = problem.evaluate_each(list(finer.values()), [()] * len(finer))
    return {
        name: base.residual - evaluation.residual
        for name, evaluation in zip(finer, found, strict=True)
        if not isinstance(evaluation, SimulationError)
    }


def with_numerical_error(fit: FitResult, changes: Mapping[str, np.ndarray]) -> FitResult:
    """The fit with standard errors that also hold the shift of the values that each refinement would bring.

    A type B contribution: the shift, linearised, counts as one standard error (JCGM 100:2008, 4.3; ASME V&V 20-2009
    combines numerical and measurement uncertainty likewise). changes: as from `changes_by_refinement`.
    """
    squares = sum((_shift(fit.evaluation.jacobian, change) ** 2 for change in changes.values()), start=0.0)
    known = fit.model.parameters
    errors = {
        name: float(np.hypot(known[name].standard_error, np.sqrt(square)))
        for name, square in zip(
            fit.evaluation.names, np.broadcast_to(squares, len(fit.evaluation.names)), strict=True
        )
        if known[name].standard_error is not None
    }
    return replace(fit, model=fit.model.with_values(fit.model.values, errors))


def _shift(jacobian: np.ndarray, change: np.ndarray) -> np.ndarray:
    """Change of least-squares estimates [parameters] when the simulated series [frames] changes."""
    if jacobian.shape[1] == 0:
        return np.zeros(0)
    scale = np.linalg.norm(jacobian, axis=0)
    safe = np.where(scale > 0, scale, 1.0)
    return -np.linalg.lstsq(jacobian / safe, change, rcond=_UNSEEN)[0] / safe
