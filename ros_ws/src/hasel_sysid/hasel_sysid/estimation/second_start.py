"""What a fit left where no derivative leads on, and the fit once more with it at its typical size."""

from collections.abc import Callable
from dataclasses import replace

from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.estimation.result import FitResult


def better_from(
    first: FitResult, values: dict[str, float], fitted: Callable[[Model], FitResult]
) -> FitResult:
    """The first fit, or one from the same model with these values, whichever leaves less; no values: the first.

    iterations: those of both. A start that cannot be simulated leaves the first.
    """
    if not values:
        return first
    try:
        again = fitted(first.model.with_values(values))
    except SimulationError:
        return first
    best = min(first, again, key=lambda fit: fit.evaluation.sum_of_squares)
    return replace(best, iterations=first.iterations + again.iterations)


def typical_values(model: Model) -> dict[str, float]:
    """Of every parameter of an effect."""
    return {f"{effect.id}.{p.name}": p.typical for effect in model.effects for p in effect.parameters}


def on_flat_bounds(fit: FitResult) -> dict[str, float]:
    """Typical values of what lies on a bound where nothing shows it: of a time far below a step there is no slope.

    A step of the search that overshot has put it there, and no derivative leads back.
    """
    flat = set(fit.at_bound) & set(fit.undetermined)
    return {name: value for name, value in typical_values(fit.model).items() if name in flat}


def left_without_effect(fit: FitResult) -> dict[str, float]:
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
