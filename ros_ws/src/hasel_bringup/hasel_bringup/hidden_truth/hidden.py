# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What `hidden` says, of every command, node and launch file: nothing, any effect, named effects, or values."""

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from hasel_common.names import nearest_name

from hasel_bringup.errors import BringupError

if TYPE_CHECKING:
    import numpy as np
    from hasel_sim.effects.base import EffectParameter
    from hasel_sim.model import Model

RANDOM, NOTHING = "random", "none"
MEANING = (
    "what the swimmer has beyond the model: none, random, effects, or values: quadratic_drag.coefficient=0.25"
)


def hideable() -> list[str]:
    """Effects that change how the body moves: those of the observation would not show in a picture of its markers."""
    from hasel_sim.effects.base import ObservationEffect
    from hasel_sim.effects.registry import catalogue

    return [name for name, effect in catalogue().items() if not isinstance(effect, ObservationEffect)]


def check_hidden(words: Iterable[str]) -> None:
    """Raises BringupError for a word that is neither none, random, an effect that moves the body, nor name=value."""
    for word in words:
        name, separator, value = word.partition("=")
        if separator:
            try:
                float(value)
            except ValueError:
                raise BringupError(
                    f"'{word}' cannot be hidden; expected a number behind '=', as in quadratic_drag.coefficient=0.25"
                ) from None
            name = name.rpartition(".")[0]
        if name not in ("", RANDOM, NOTHING) and name not in (known := hideable()):
            raise BringupError(
                f"'{word}' cannot be hidden; expected {NOTHING}, {RANDOM}, name=value or an effect that moves the "
                f"body: {nearest_name(name, known)}"
            )


def hidden_values(words: Sequence[str], generator: "np.random.Generator") -> dict[str, float]:
    """Values by the name of their parameter; an effect without values gets about its typical size.

    Raises BringupError for a word that says nothing.
    """
    check_hidden(words)
    values: dict[str, float] = {}
    for word in words:
        name, separator, text = word.partition("=")
        if separator:
            values[name] = float(text)
        elif name != NOTHING:
            effect = str(generator.choice(hideable())) if name == RANDOM else name
            drawn = draw_hidden_values(effect, 1.0, generator)
            values.update({f"{effect}.{parameter}": value for parameter, value in drawn.items()})
    return values


def draw_hidden_values(
    source: str, size: float, generator: "np.random.Generator", spread_null: bool = False
) -> dict[str, float]:
    """Value of every parameter of an effect, by name, within 10 % of its size.

    source: the effect's id or path/to/file.py:Class; size: in typical values, negative for the other sign;
    spread_null: a parameter that is typically at its null value lies within 10 % of that.
    """
    from hasel_sim.effects.registry import find_effects

    effect = find_effects((source,))[0]
    return {p.name: _value(p, size, generator, spread_null) for p in effect.parameters}


def both_signs(source: str) -> bool:
    """Whether an effect's first parameter can plausibly lie on either side of its null value."""
    from hasel_sim.effects.registry import find_effects

    first = find_effects((source,))[0].parameters[0]
    return first.lower < first.null < first.upper


def _value(p: "EffectParameter", size: float, generator: "np.random.Generator", spread_null: bool) -> float:
    jitter = generator.uniform(0.9, 1.1)
    if p.scan:
        low, high = p.scan[1], p.scan[-2]
        return float(low * (high / low) ** generator.uniform())
    if spread_null and p.typical == p.null:
        return float(p.null * jitter)
    away = size * (p.typical - p.null) * jitter
    if p.lower >= p.null:
        away = abs(away)
    return float(min(max(p.null + away, p.lower), p.upper))


def with_hidden(model: "Model", values: Mapping[str, float]) -> "Model":
    """The model with these values; an effect named before the dot is added first.

    Raises ModelError for a parameter that is not there or a value out of its range.
    """
    from hasel_sim.errors import ModelError

    for name, value in values.items():
        effect = name.rpartition(".")[0]
        if effect and effect not in {known.id for known in model.effects}:
            model = model.with_effects(effect)
        parameter = model.parameter(name)
        if not parameter.lower <= value <= parameter.upper:
            unit = "" if parameter.unit == "1" else f" {parameter.unit}"
            raise ModelError(
                f"{name} = {value:g}{unit} is out of range; expected {parameter.lower:g} to {parameter.upper:g}"
            )
        model = model.with_values({name: value})
    return model
