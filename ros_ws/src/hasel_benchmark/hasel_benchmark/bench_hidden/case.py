"""One case of the benchmark: what is hidden, how large, under which noise, in which truth."""

import zlib
from dataclasses import asdict, dataclass

import numpy as np
from hasel_bringup.hidden_truth.drawn_values import draw_hidden_values

from hasel_benchmark.bench_hidden.unlisted import UNLISTED

KINDS = ("nothing", "single", "strong", "pair", "unlisted", "set_up")


@dataclass(frozen=True)
class Case:
    """effects: ids of what is hidden; size: in typical values, negative for the other sign; seed: of every draw;
    fault: of the set-up, that is hidden too.
    """

    kind: str
    effects: tuple[str, ...]
    size: float
    seed: int
    colour: str
    numerics: str
    fault: str = ""

    @property
    def name(self) -> str:
        """Unique, and fit for a file name."""
        hidden = "+".join(filter(None, [*self.effects, self.fault])) or "nothing"
        return f"{self.kind}-{hidden}-{self.size:+g}-{self.colour}-{self.numerics}-{self.seed}"

    def generator(self) -> np.random.Generator:
        """Random numbers of this case alone, the same on every machine."""
        return np.random.default_rng([self.seed, zlib.crc32(self.name.encode())])

    def as_dict(self) -> dict:
        """For JSON."""
        return {**asdict(self), "effects": list(self.effects)}

    def __str__(self) -> str:
        hidden = " and ".join(filter(None, [*self.effects, self.fault])) or "nothing"
        return f"{hidden} hidden, {self.size:+g} x typical, {self.colour} noise, seed {self.seed}"


def effect_source(identity: str) -> str:
    """What a model file calls an effect: its id, or the file of one that stands in no catalogue."""
    return UNLISTED.get(identity, identity)


def draw_values(case: Case, generator: np.random.Generator) -> dict[str, dict[str, float]]:
    """Value of every parameter of the hidden effects, by effect id and parameter name."""
    return {
        identity: draw_hidden_values(effect_source(identity), case.size, generator, identity in UNLISTED)
        for identity in case.effects
    }
