"""One case of the benchmark: what is hidden, how large, under which noise, in which truth."""

import zlib
from dataclasses import asdict, dataclass

import numpy as np
from hasel_sim.effects.base import EffectParameter
from hasel_sim.effects.registry import find_effects

from hasel_bringup.bench_hidden.unlisted import UNLISTED

KINDS = ("nothing", "single", "pair", "unlisted")


@dataclass(frozen=True)
class Case:
    """effects: ids of what is hidden; size: in typical values, negative for the other sign; seed: of every draw."""

    kind: str
    effects: tuple[str, ...]
    size: float
    seed: int
    colour: str
    numerics: str

    @property
    def name(self) -> str:
        """Unique, and fit for a file name."""
        hidden = "+".join(self.effects) or "nothing"
        return f"{self.kind}-{hidden}-{self.size:+g}-{self.colour}-{self.numerics}-{self.seed}"

    def generator(self) -> np.random.Generator:
        """Random numbers of this case alone, the same on every machine."""
        return np.random.default_rng([self.seed, zlib.crc32(self.name.encode())])

    def as_dict(self) -> dict:
        """For JSON."""
        return {**asdict(self), "effects": list(self.effects)}

    def __str__(self) -> str:
        hidden = " and ".join(self.effects) or "nothing"
        return f"{hidden} hidden, {self.size:+g} x typical, {self.colour} noise, seed {self.seed}"


def effect_source(identity: str) -> str:
    """What a model file calls an effect: its id, or the file of one that stands in no catalogue."""
    return UNLISTED.get(identity, identity)


def draw_values(case: Case, generator: np.random.Generator) -> dict[str, dict[str, float]]:
    """Value of every parameter of the hidden effects, by effect id and parameter name."""
    return {identity: _values(identity, case.size, generator) for identity in case.effects}


def _values(identity: str, size: float, generator: np.random.Generator) -> dict[str, float]:
    effect = find_effects((effect_source(identity),))[0]
    return {p.name: _value(p, size, generator, identity in UNLISTED) for p in effect.parameters}


def _value(p: EffectParameter, size: float, generator: np.random.Generator, unlisted: bool) -> float:
    jitter = generator.uniform(0.9, 1.1)
    if p.scan:
        low, high = p.scan[1], p.scan[-2]
        return float(low * (high / low) ** generator.uniform())
    if unlisted and p.typical == p.null:
        return float(p.null * jitter)
    away = size * (p.typical - p.null) * jitter
    if p.lower >= p.null:
        away = abs(away)
    return float(np.clip(p.null + away, p.lower, p.upper))


def both_signs(identity: str) -> bool:
    """Whether an effect's first parameter can plausibly lie on either side of its null value."""
    first = find_effects((effect_source(identity),))[0].parameters[0]
    return first.lower < first.null < first.upper
