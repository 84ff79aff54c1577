"""Effects for tests: in a simulation they do nothing, and what they would change is made up beside them."""

from dataclasses import replace

from hasel_sim.effects.base import Effect, EffectParameter, ObservationEffect
from hasel_sim.model import Model, Parameter


def made_up_size(largest: float = 10.0) -> EffectParameter:
    """A size that is noticed at 1."""
    return EffectParameter("size", "x", "1", 0.0, 0.0, largest, 1.0)


def made_up_effect(name: str, *parameters: EffectParameter) -> Effect:
    """An effect of this name; default of its parameters: one size."""
    return type(name, (ObservationEffect,), {"id": name, "parameters": parameters or (made_up_size(),)})()


def with_made_up(model: Model, *effects: Effect) -> Model:
    """The model with these effects at their nulls, as `Model.with_effects` has it of those in the catalogue."""
    sizes = {f"{effect.id}.{p.name}": p for effect in effects for p in effect.parameters}
    parameters = {name: Parameter(name, p.null, p.unit, p.lower, p.upper) for name, p in sizes.items()}
    return replace(model, effects=(*model.effects, *effects), parameters={**model.parameters, **parameters})
