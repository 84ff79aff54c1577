"""The range over which a value is dragged, and its scale."""

import math
from dataclasses import dataclass

from hasel_sim.effects.base import EffectParameter
from hasel_sim.model import Model
from hasel_sysid.report.wording import meaning, plausible

_TIMES = 4.0
"""A baseline parameter is dragged from a quarter of its value to four times it."""


@dataclass(frozen=True)
class Slider:
    """name, unit and value of a parameter, the ends of its range, and its scale asinh((value - centre) / size): even
    within a size of the centre, logarithmic beyond it, to both sides.
    """

    name: str
    unit: str
    value: float
    lowest: float
    highest: float
    centre: float
    size: float
    meaning: str
    plausible: str

    @property
    def share(self) -> float:
        """Where the value lies between the ends of the scale, 0 to 1."""
        low, at, high = (self._scaled(value) for value in (self.lowest, self.value, self.highest))
        return (at - low) / (high - low) if high > low else 0.0

    def _scaled(self, value: float) -> float:
        return math.asinh((value - self.centre) / self.size)


def sliders(model: Model) -> list[Slider]:
    """Of every free parameter, those of effects first."""
    effects = {f"{effect.id}.{each.name}": each for effect in model.effects for each in effect.parameters}
    names = sorted(model.free, key=lambda name: name not in effects)
    return [_slider(model, name, effects.get(name)) for name in names]


def _slider(model: Model, name: str, declared: EffectParameter | None) -> Slider:
    p = model.parameters[name]
    low, high = p.lower, p.upper
    if declared is None and p.value > 0:
        low, high = max(low, p.value / _TIMES), min(high, p.value * _TIMES)
    reach = _TIMES * abs(p.value) or 1.0
    low = low if math.isfinite(low) else p.value - reach
    high = high if math.isfinite(high) else p.value + reach
    low, high = min(low, p.value), max(high, p.value)
    centre, size = (0.0, abs(p.value)) if declared is None else _scale(declared)
    size = size or high - low or 1.0
    return Slider(
        name, p.unit, p.value, low, high, centre, size, meaning(name, model), plausible(name, model)
    )


def _scale(declared: EffectParameter) -> tuple[float, float]:
    """Centre and size: the null and how far from it one would notice it; 0 and the least tried where it has no null."""
    if declared.scan:
        return 0.0, min((value for value in declared.scan if value > 0), default=declared.typical)
    return declared.null, abs(declared.typical - declared.null)
