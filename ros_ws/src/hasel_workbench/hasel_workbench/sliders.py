"""The range over which a value is dragged."""

import math
from dataclasses import dataclass

from hasel_sim.model import Model
from hasel_sysid.report.parameter_words import meaning, plausible

_TIMES = 4.0
"""A baseline parameter is dragged from a quarter of its value to four times it."""
_DECADES = 30.0
"""A range whose ends differ by more than this factor is dragged over on a logarithmic scale."""


@dataclass(frozen=True)
class Slider:
    """name, unit and value of a parameter, the ends of its range, and whether its scale is logarithmic."""

    name: str
    unit: str
    value: float
    lowest: float
    highest: float
    logarithmic: bool
    meaning: str
    plausible: str


def sliders(model: Model) -> list[Slider]:
    """Of every free parameter, those of effects first."""
    effects = tuple(f"{effect.id}." for effect in model.effects)
    names = sorted(model.free, key=lambda name: not name.startswith(effects) if effects else True)
    return [_slider(model, name, bool(effects) and name.startswith(effects)) for name in names]


def _slider(model: Model, name: str, of_effect: bool) -> Slider:
    p = model.parameters[name]
    low, high = p.lower, p.upper
    if not of_effect and p.value > 0:
        low, high = max(low, p.value / _TIMES), min(high, p.value * _TIMES)
    reach = _TIMES * abs(p.value) or 1.0
    low = low if math.isfinite(low) else p.value - reach
    high = high if math.isfinite(high) else p.value + reach
    low, high = min(low, p.value), max(high, p.value)
    logarithmic = low > 0 and high / low > _DECADES
    return Slider(name, p.unit, p.value, low, high, logarithmic, meaning(name, model), plausible(name, model))
