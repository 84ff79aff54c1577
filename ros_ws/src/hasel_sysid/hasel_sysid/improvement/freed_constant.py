"""A constant of a model file that is free to be fitted."""

from dataclasses import replace

from hasel_sim.errors import ModelError
from hasel_sim.model import Model
from hasel_sim.model.constants import constants

_RANGE = 0.3, 3.0
"""How far a constant may be from what the file says, as the scale of a modulus may."""


def held_constants(model: Model) -> list[str]:
    """The constants that a model's file gives and that are no parameters yet; one of 0 has no range."""
    return [
        name for name, value in constants(model.description).items() if value and name not in model.parameters
    ]


def freed(model: Model, name: str) -> Model:
    """The model with a constant free within its range."""
    out = model.with_freed(name)
    p = out.parameters[name]
    ends = sorted(share * p.value for share in _RANGE)
    return replace(out, parameters={**out.parameters, name: replace(p, lower=ends[0], upper=ends[1])})


def is_possible(model: Model, name: str) -> bool:
    """Whether a file may say what a model has for a constant."""
    try:
        model.with_constants_settled(name)
    except ModelError:
        return False
    return True
