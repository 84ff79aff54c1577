"""Identification as a user asks for it: a fit by a named method, with honest standard errors."""

from collections.abc import Callable

from hasel_sim.errors import nearest_name
from hasel_sim.model import Model

from hasel_sysid.errors import SysidError
from hasel_sysid.fit.adam import fit_adam
from hasel_sysid.fit.least_squares import Progress, fit_least_squares
from hasel_sysid.fit.refinement import changes_by_refinement, with_numerical_error
from hasel_sysid.fit.result import FitResult
from hasel_sysid.problem import Problem

METHODS: dict[str, Callable[..., FitResult]] = {"least_squares": fit_least_squares, "adam": fit_adam}
"""Ways to fit, by the name that `fit --method` takes."""


def identify(problem: Problem, model: Model, method: str, progress: Progress | None = None) -> FitResult:
    """Fit the model's free parameters; the standard errors hold noise, scatter between runs and discretisation.

    Raises SysidError for an unknown method, SimulationError when the start cannot be simulated.
    """
    if method not in METHODS:
        raise SysidError(f"unknown method '{method}'; {nearest_name(method, METHODS)}")
    fit = METHODS[method](problem, model, progress)
    return with_numerical_error(fit, changes_by_refinement(problem, fit.evaluation))
