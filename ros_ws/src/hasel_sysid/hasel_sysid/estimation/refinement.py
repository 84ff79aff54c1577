"""The discretisation error: what the model's own mesh, time step and interpolation do to fitted values."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.estimation.directions import seen_directions
from hasel_sysid.estimation.result import FitResult
from hasel_sysid.problem import Evaluation, Problem


def refinements(model: Model) -> dict[str, Model]:
    """The model on a mesh finer along and across it, and with shorter time steps.

    Where the drive passes levels at which no amplitude is known, also with another curve between those that are: no
    finer one is to be had, and either is as likely.
    """
    numerics = model.description.numerics
    found = {
        "mesh": model.with_numerics(mesh_density=1.5 * numerics.mesh_density, layers=numerics.layers + 1),
        "time_step": model.with_numerics(steps_per_second=2 * numerics.steps_per_second),
    }
    if any(map(model.is_onset, model.parameters)):
        other = "power" if numerics.amplitude_curve == "cubic" else "cubic"
        found["amplitude_curve"] = model.with_numerics(amplitude_curve=other)
    return found


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
    """The fit with standard errors that also hold its discretisation error: the shift that each refinement would bring.

    A type B contribution: the shift, linearised, counts as one standard error (JCGM 100:2008, 4.3; ASME V&V 20-2009
    combines numerical and measurement uncertainty likewise). changes: as from `changes_by_refinement`.
    """
    names, seen = fit.evaluation.names, seen_directions(fit.evaluation.jacobian)
    shifts = [seen.estimate(change) for change in changes.values()]
    covariance = fit.model.covariance(names) + sum(
        (np.outer(shift, shift) for shift in shifts), start=np.zeros((len(names), len(names)))
    )
    return replace(
        fit, model=fit.model.with_covariance(names, covariance), changes_by_refinement=dict(changes)
    )


def refined(problem: Problem, fit: FitResult) -> FitResult:
    """The same, its refinements simulated now."""
    return with_numerical_error(fit, changes_by_refinement(problem, fit.evaluation))
