"""How large a hidden effect is."""

import numpy as np
from hasel_sim.effects.base import EffectParameter
from hasel_sim.effects.registry import find_effects


def draw_hidden_values(
    source: str, size: float, generator: np.random.Generator, spread_null: bool = False
) -> dict[str, float]:
    """Value of every parameter of an effect, by name, within 10 % of its size.

    source: the effect's id or path/to/file.py:Class; size: in typical values, negative for the other sign;
    spread_null: a parameter that is typically at its null value lies within 10 % of that.
    """
    effect = find_effects((source,))[0]
    return {p.name: _value(p, size, generator, spread_null) for p in effect.parameters}


def both_signs(source: str) -> bool:
    """Whether an effect's first parameter can plausibly lie on either side of its null value."""
    first = find_effects((source,))[0].parameters[0]
    return first.lower < first.null < first.upper


def _value(p: EffectParameter, size: float, generator: np.random.Generator, spread_null: bool) -> float:
    jitter = generator.uniform(0.9, 1.1)
    if p.scan:
        low, high = p.scan[1], p.scan[-2]
        return float(low * (high / low) ** generator.uniform())
    if spread_null and p.typical == p.null:
        return float(p.null * jitter)
    away = size * (p.typical - p.null) * jitter
    if p.lower >= p.null:
        away = abs(away)
    return float(np.clip(p.null + away, p.lower, p.upper))
