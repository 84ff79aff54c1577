"""Identification as a user asks for it: a fit by a named method, with honest standard errors."""

from collections.abc import Callable

from hasel_common.names import nearest_name
from hasel_sim.model import Model

from hasel_sysid.errors import SysidError
from hasel_sysid.estimation.fit import FittedModel, fit_baseline, refined
from hasel_sysid.problem import Problem
from hasel_sysid.seed_paper import fit_adam

METHODS: dict[str, Callable[..., FittedModel]] = {"least_squares": fit_baseline, "adam": fit_adam}
"""Ways to fit, by the name that `fit --method` takes."""


def identify(problem: Problem, model: Model, method: str = "least_squares") -> FittedModel:
    """Fit the model's free parameters; the standard errors hold noise, scatter between runs and discretisation.

    Raises SysidError for an unknown method, SimulationError when no start can be simulated.
    """
    if method not in METHODS:
        raise SysidError(f"unknown method '{method}'; {nearest_name(method, METHODS)}")
    return refined(problem, METHODS[method](problem, model))
