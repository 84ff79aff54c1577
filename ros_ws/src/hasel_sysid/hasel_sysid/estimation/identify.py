"""Identification as a user asks for it: a fit by a named method, with honest standard errors."""

from collections.abc import Callable

from hasel_sim.errors import nearest_name
from hasel_sim.model import Model

from hasel_sysid.errors import SysidError
from hasel_sysid.estimation.adam import fit_adam
from hasel_sysid.estimation.from_afar import fit_from_afar
from hasel_sysid.estimation.least_squares import Progress
from hasel_sysid.estimation.refinement import changes_by_refinement, with_numerical_error
from hasel_sysid.estimation.result import FitResult
from hasel_sysid.problem import Problem

METHODS: dict[str, Callable[..., FitResult]] = {"least_squares": fit_from_afar, "adam": fit_adam}
"""Ways to fit, by the name that `fit --method` takes."""


def identify(problem: Problem, model: Model, method: str, progress: Progress | None = None) -> FitResult:
    """Fit the model's free parameters; the standard errors hold noise, scatter between runs and discretisation.

    An effect that a fit leaves without effect, as `add` wrote it, is tried once more from its typical size: where it
    does nothing its derivative may be nothing too. Raises SysidError for an unknown method, SimulationError when the
    start cannot be simulated.
    """
    if method not in METHODS:
        raise SysidError(f"unknown method '{method}'; {nearest_name(method, METHODS)}")
    fit = METHODS[method](problem, model, progress)
    asleep = _left_without_effect(fit)
    if asleep:
        again = METHODS[method](problem, fit.model.with_values(asleep), progress)
        fit = min(fit, again, key=lambda result: result.evaluation.sum_of_squares)
    return with_numerical_error(fit, changes_by_refinement(problem, fit.evaluation))


def _left_without_effect(fit: FitResult) -> dict[str, float]:
    """Typical values of the effects of which every fitted parameter ended on a bound that is its null, by name."""
    typical: dict[str, float] = {}
    for effect in fit.model.effects:
        sizes = [
            p for p in effect.parameters if not p.scan and f"{effect.id}.{p.name}" in fit.evaluation.names
        ]
        names = [f"{effect.id}.{p.name}" for p in sizes]
        null = all(
            name in fit.at_bound and abs(fit.model.values[name] - p.null) < 1e-3 * abs(p.typical - p.null)
            for name, p in zip(names, sizes, strict=True)
        )
        if sizes and null:
            typical |= {name: p.typical for name, p in zip(names, sizes, strict=True)}
    return typical
