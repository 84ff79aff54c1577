"""What a fit left where no derivative leads on, and the fit once more with it at its typical size."""

from collections.abc import Callable
from dataclasses import replace

from hasel_sim.effects.base import EffectParameter
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model, Parameter

from hasel_sysid.estimation.result import FitResult


def better_from(
    first: FitResult,
    values: dict[str, float],
    fitted: Callable[[Model], FitResult],
    of: Model | None = None,
) -> FitResult:
    """The first fit, or one from a model with these values, whichever leaves less; no values: the first.

    of: the model that is begun from, else that of the first fit. iterations: those of both. A start that cannot be
    simulated leaves the first.
    """
    if not values:
        return first
    try:
        again = fitted((of or first.model).with_values(values))
    except SimulationError:
        return first
    best = min(first, again, key=lambda fit: fit.evaluation.sum_of_squares)
    return replace(best, iterations=first.iterations + again.iterations)


def typical_values(model: Model) -> dict[str, float]:
    """Of every parameter of an effect."""
    return {f"{effect.id}.{p.name}": p.typical for effect in model.effects for p in effect.parameters}


def unseen_parts(fit: FitResult) -> dict[str, float]:
    """Typical values of what a fit left within its own standard error of doing nothing, by name: on a bound where
    nothing shows it, or beside other parts of its effect that do something.

    What is hidden behind another limit, as a lag behind the slowest rise, has no slope there; a step of the search that
    overshot has put it there, and no derivative leads back.
    """
    found: dict[str, float] = {}
    for effect in fit.model.effects:
        sizes = {f"{effect.id}.{p.name}": p for p in effect.parameters if not p.scan}
        near = {name for name, p in sizes.items() if _is_near(fit, name, p.null)}
        flat = {name for name in near if name in fit.at_bound and name in fit.undetermined}
        chosen = near if len(near) < len(sizes) else flat
        found |= {name: sizes[name].typical for name in chosen if sizes[name].typical != sizes[name].null}
    return found


def onsets_to_doubt(fit: FitResult) -> dict[str, float]:
    """No onset at all, by name, in place of one that a fit drove to its upper bound, or of one that nothing shows.

    Up there a lag only delays, and what delays a little and begins late looks like what delays much and begins at once;
    and what stays below an onset does nothing.
    """
    onsets = [p for p in fit.model.parameters.values() if fit.model.is_onset(p.name) and p.free]
    above = {p.name for p in onsets if p.name in fit.at_bound and p.value > 0.5 * p.upper}
    return {p.name: 0.0 for p in onsets if p.name in above or (p.value > 0.0 and p.name in fit.undetermined)}


def _is_near(fit: FitResult, name: str, null: float) -> bool:
    """Whether a fitted parameter is within its standard error of a value on one of its bounds."""
    p = fit.model.parameters[name]
    if name not in fit.evaluation.names or null not in (p.lower, p.upper):
        return False
    return abs(p.value - null) <= (p.standard_error if p.standard_error is not None else float("inf"))


def asleep(model: Model) -> dict[str, float]:
    """Typical values of the effects whose every free size is at its null, as `add` writes them, by name."""
    return _typical_of_effects(model, lambda p, size: p.value == size.null)


def left_without_effect(fit: FitResult) -> dict[str, float]:
    """Typical values of the effects of which every fitted parameter ended on a bound that is its null, by name."""

    def ended_at_null(p: Parameter, size: EffectParameter) -> bool:
        return p.name in fit.at_bound and abs(p.value - size.null) < 1e-3 * abs(size.typical - size.null)

    return _typical_of_effects(fit.model, ended_at_null)


def _typical_of_effects(
    model: Model, does_nothing: Callable[[Parameter, EffectParameter], bool]
) -> dict[str, float]:
    typical: dict[str, float] = {}
    for effect in model.effects:
        sizes = {f"{effect.id}.{p.name}": p for p in effect.parameters if not p.scan}
        free = {name: size for name, size in sizes.items() if model.parameters[name].free}
        if free and all(does_nothing(model.parameters[name], size) for name, size in free.items()):
            typical |= {name: size.typical for name, size in free.items()}
    return typical
