# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is known of an effect or a value, for the person who decides whether to try it."""

import math
from dataclasses import dataclass

from hasel_sim.effects.base import Effect, EffectParameter
from hasel_sim.model import Model
from hasel_sysid.answer.diagnosis import Diagnosis, Finding
from hasel_sysid.candidates import candidate_effects
from hasel_sysid.report.wording import meaning, of_effect, plausible


@dataclass(frozen=True)
class Card:
    """kind: the effect; on: whether the model has it; finding: what a diagnosis says of it, None before one."""

    kind: Effect
    on: bool
    finding: Finding | None = None

    @property
    def effect(self) -> str:
        """Its id."""
        return self.kind.id

    @property
    def verdict(self) -> str:
        """Of the diagnosis; empty before one."""
        return "" if self.finding is None else self.finding.verdict.value

    @property
    def parameters(self) -> list[tuple[str, str]]:
        """Name with symbol and unit, and plausible range with its source."""
        units = {p.name: "" if p.unit == "1" else f" [{p.unit}]" for p in self.kind.parameters}
        return [(f"{p.name} ({p.symbol}){units[p.name]}", of_effect(p)) for p in self.kind.parameters]


def cards(model: Model, diagnosis: Diagnosis | None, only: tuple[str, ...] | None = None) -> list[Card]:
    """Of every effect that the model has or could have, the most probable first where a diagnosis has ranked them."""
    found = {} if diagnosis is None else {finding.effect: finding for finding in diagnosis.findings}
    own = [Card(effect, True) for effect in model.effects]
    others = [Card(effect, False, found.get(effect.id)) for effect in candidate_effects(model, only)]
    order = {name: number for number, name in enumerate(found)}
    return own + sorted(others, key=lambda card: order.get(card.effect, len(order)))


def source_of(model: Model, effect: str, only: tuple[str, ...] | None = None) -> str:
    """By what name a model file knows an effect: its id, or the file that it is in."""
    known = {each.id: each for each in candidate_effects(model, only)}
    return (known[effect].source or effect) if effect in known else effect


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
        values = (self.lowest, self.value, self.highest)
        low, at, high = (math.asinh((value - self.centre) / self.size) for value in values)
        return (at - low) / (high - low) if high > low else 0.0


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
    words = meaning(name, model), plausible(name, model)
    return Slider(name, p.unit, p.value, low, high, centre, size, *words)


def _scale(declared: EffectParameter) -> tuple[float, float]:
    """Centre and size: the null and how far from it one would notice it; 0 and the least tried where it has no null."""
    if declared.scan:
        return 0.0, min((value for value in declared.scan if value > 0), default=declared.typical)
    return declared.null, abs(declared.typical - declared.null)
