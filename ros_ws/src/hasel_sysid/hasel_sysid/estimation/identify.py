"""Identification as a user asks for it: a fit by a named method, with honest standard errors."""

from collections.abc import Callable
from functools import partial

from hasel_sim.errors import nearest_name
from hasel_sim.model import Model

from hasel_sysid.errors import SysidError
from hasel_sysid.estimation.adam import fit_adam
from hasel_sysid.estimation.from_afar import fit_from_afar
from hasel_sysid.estimation.least_squares import Progress
from hasel_sysid.estimation.refinement import refined
from hasel_sysid.estimation.result import FitResult
from hasel_sysid.estimation.second_start import asleep, better_from, left_without_effect
from hasel_sysid.problem import Problem

METHODS: dict[str, Callable[..., FitResult]] = {"least_squares": fit_from_afar, "adam": fit_adam}
"""Ways to fit, by the name that `fit --method` takes."""


def identify(problem: Problem, model: Model, method: str, progress: Progress | None = None) -> FitResult:
    """Fit the model's free parameters; the standard errors hold noise, scatter between runs and discretisation.

    An effect that does nothing at the start, as `add` writes it, or that a fit leaves without effect, is tried once
    more from its typical size: where it does nothing its derivative may be nothing too. Raises SysidError for an
    unknown method, SimulationError when the start cannot be simulated.
    """
    if method not in METHODS:
        raise SysidError(f"unknown method '{method}'; {nearest_name(method, METHODS)}")
    fitted = partial(METHODS[method], problem, progress=progress)
    first = fitted(model)
    sleeping = asleep(model)
    fit = better_from(first, sleeping, fitted, model)
    if not sleeping:
        fit = better_from(first, left_without_effect(first), fitted)
    return refined(problem, fit)
