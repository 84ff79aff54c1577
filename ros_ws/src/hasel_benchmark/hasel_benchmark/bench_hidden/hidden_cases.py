# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is hidden: an effect, two, a fault of the set-up, or nothing; how large, under which noise, in which truth."""

import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import chain
from typing import Any

import numpy as np
from hasel_bringup.hidden_truth.hidden import both_signs, draw_hidden_values
from hasel_common.names import nearest_name
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.model import load_model
from hasel_sim.run import Run
from hasel_sysid.candidates import candidate_effects

from hasel_benchmark.bench_hidden.unlisted_effects import UNLISTED
from hasel_benchmark.errors import BenchmarkError

SIZES = (1.0, 2.0, 0.5)
"""In typical values; a seed takes one after the other."""
STRONG = (5.0, 1e3)
"""In typical values; the latter is the end of the plausible range."""
BESIDE_A_FAULT = ("", "quadratic_drag", "charging_lag")
"""What a fault of the set-up has beside it; a seed takes one after the other."""
UNLISTED_SEEDS = len(SIZES)
"""What no catalogue lists is hidden once at every size: to find no explanation takes longest."""
NOTHING_PER_SEED = 8
_COLOURS = ("white", "coloured")
PAIRS = (
    ("quadratic_drag", "muscle_asymmetry"),
    ("charging_lag", "gain_drift"),
    ("viscoelastic_creep", "camera_latency"),
    ("linear_drag", "charge_retention"),
    ("hydraulic_lag", "soft_modulus"),
    ("material_damping", "muscle_asymmetry"),
    ("surface_friction", "transport_delay"),
    ("spine_modulus", "gain_drift"),
    ("added_mass", "charging_lag"),
    ("structural_damping", "force_length"),
)
"""Of effects that act in different ways, so that each leaves something of its own."""
_LATE_S, _EARLY_S = 0.15, -0.05
"""By how much clocks differ: more than a supply or a camera is late, and less than nothing."""


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


def list_cases(
    kinds: Sequence[str], seeds: Sequence[int], effects: Sequence[str], numerics: str
) -> list[Case]:
    """All cases of these kinds, seed by seed, so that a benchmark broken off early is a smaller whole one.

    seeds: from which each effect's size, sign, noise and muscles follow; effects: only cases that hide one of these,
    empty for all. Raises BenchmarkError for an unknown effect.
    """
    known = [*listed_effects(), *UNLISTED]
    for name in effects:
        if name not in known:
            raise BenchmarkError(f"There is no effect '{name}' to hide; {nearest_name(name, known)}.")
    listed = chain.from_iterable(
        _of_seed(seed, numerics, with_unlisted=number < UNLISTED_SEEDS) for number, seed in enumerate(seeds)
    )
    chosen = set(effects)
    return [case for case in listed if case.kind in kinds and (not chosen or chosen & set(case.effects))]


@cache
def listed_effects() -> tuple[str, ...]:
    """Ids of the catalogue that can act on the swimmer: it names no medium, and starts straight."""
    possible = candidate_effects(load_model("swimmer"))
    return tuple(effect.id for effect in possible if not effect.needs_strained_start)


def _of_seed(seed: int, numerics: str, with_unlisted: bool) -> list[Case]:
    size = SIZES[seed % len(SIZES)]
    cases = [
        Case("nothing", (), 0.0, seed * NOTHING_PER_SEED + n, _COLOURS[n % 2], numerics)
        for n in range(NOTHING_PER_SEED)
    ]
    beside = BESIDE_A_FAULT[seed % len(BESIDE_A_FAULT)]
    cases += [
        Case("set_up", (beside,) if beside else (), 1.0, seed, _COLOURS[n % 2], numerics, fault)
        for n, fault in enumerate(FAULTS)
    ]
    for strong in STRONG:
        for n, identity in enumerate(listed_effects()):
            sign = -1.0 if seed % 2 and both_signs(identity) else 1.0
            cases.append(Case("strong", (identity,), sign * strong, seed, _COLOURS[n % 2], numerics))
    shown = (
        *(("single", (identity,)) for identity in listed_effects()),
        *(("unlisted", (identity,)) for identity in UNLISTED if with_unlisted),
        *(("pair", pair) for pair in PAIRS[seed % 2 :: 2]),
    )
    for number, (kind, hidden) in enumerate(shown):
        sign = -1.0 if seed % 2 and kind != "pair" and both_signs(effect_source(hidden[0])) else 1.0
        colour = _COLOURS[(seed + NOTHING_PER_SEED + number) % 2]
        cases.append(Case(kind, hidden, sign * size, seed, colour, numerics))
    return cases


def quick_cases(numerics: str) -> list[Case]:
    """A handful that shows within minutes whether anything is broken."""
    return [
        Case("nothing", (), 0.0, 0, "coloured", numerics),
        Case("single", ("quadratic_drag",), 1.0, 0, "white", numerics),
        Case("single", ("muscle_asymmetry",), -1.0, 1, "coloured", numerics),
        Case("single", ("charging_lag",), 1.0, 0, "white", numerics),
        Case("unlisted", ("stirred_bath",), 1.0, 0, "white", numerics),
    ]


@dataclass(frozen=True)
class SetUpFaultHidden:
    """everywhere: in all runs, or in one; drives: the run that the truth makes of a command; sign: of the angle;
    said: words that name it, either of them; effect: of the catalogue that is this fault, if there is one.
    """

    everywhere: bool
    drives: Callable[[Run], Run]
    said: tuple[str, ...]
    sign: float = 1.0
    effect: str = ""

    def runs(self, fitted: Sequence[str], every: Sequence[str], generator: np.random.Generator) -> set[str]:
        """The names of the runs that have it: of every one, or of one that is fitted."""
        return set(every) if self.everywhere else {fitted[int(generator.integers(len(fitted)))]}


def _schedule(run: Run) -> DriveSchedule:
    if run.schedule is None:
        raise BenchmarkError(
            f"{run.name} is passive, but a fault of the drive needs one: choose another run."
        )
    return run.schedule


def _commanded(run: Run, **otherwise: Any) -> Run:
    return replace(run, schedule=replace(_schedule(run), **otherwise))


def _dead(channel: int) -> Callable[[Run], Run]:
    return lambda run: _commanded(run, signal=np.where(np.arange(2) == channel, 0.0, _schedule(run).signal))


def _late(lag_s: float) -> Callable[[Run], Run]:
    """The camera's clock is ahead: what the body does is seen later than it was commanded."""
    return lambda run: _commanded(run, time=_schedule(run).time + lag_s)


def _exchanged(run: Run) -> Run:
    return _commanded(run, signal=_schedule(run).signal[:, ::-1])


_OPPOSITE = ("wrong sign", "exchanged")
FAULTS = {
    "dead_upper_channel": SetUpFaultHidden(False, _dead(0), ("upper channel is dead",)),
    "dead_lower_channel": SetUpFaultHidden(True, _dead(1), ("lower channel is dead",)),
    "exchanged_channels": SetUpFaultHidden(False, _exchanged, _OPPOSITE),
    "inverted_angle": SetUpFaultHidden(True, lambda run: run, _OPPOSITE, sign=-1.0),
    "late_clock": SetUpFaultHidden(False, _late(_LATE_S), ("clock of the angle is off",)),
    "early_clock": SetUpFaultHidden(True, _late(_EARLY_S), (), effect="camera_latency"),
}
"""What is hidden, by name."""
