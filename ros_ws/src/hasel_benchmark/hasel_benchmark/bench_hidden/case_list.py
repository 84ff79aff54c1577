"""Which cases the benchmark runs."""

from collections.abc import Sequence
from functools import cache
from itertools import chain

from hasel_bringup.hidden_truth.drawn_values import both_signs
from hasel_common.names import nearest_name
from hasel_sim.model import load_model
from hasel_sysid.candidates import candidate_effects

from hasel_benchmark.bench_hidden.case import Case, effect_source
from hasel_benchmark.bench_hidden.set_up_faults import FAULTS
from hasel_benchmark.bench_hidden.unlisted import UNLISTED
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


def list_cases(
    kinds: Sequence[str], seeds: Sequence[int], effects: Sequence[str], numerics: str
) -> list[Case]:
    """All cases of these kinds, seed by seed, so that a benchmark broken off early is a smaller whole one.

    seeds: from which each effect's size, sign, noise and muscles follow; effects: only cases that hide one of these,
    empty for all. Raises BenchmarkError for an unknown effect.
    """
    for name in effects:
        if name not in known_effects():
            raise BenchmarkError(
                f"There is no effect '{name}' to hide; {nearest_name(name, known_effects())}."
            )
    listed = chain.from_iterable(
        _of_seed(seed, numerics, with_unlisted=number < UNLISTED_SEEDS) for number, seed in enumerate(seeds)
    )
    chosen = set(effects)
    return [case for case in listed if case.kind in kinds and (not chosen or chosen & set(case.effects))]


def known_effects() -> list[str]:
    """Ids of everything that can be hidden."""
    return [*listed_effects(), *UNLISTED]


@cache
def listed_effects() -> tuple[str, ...]:
    """Ids of the catalogue that can act on the swimmer: it names no medium, and starts straight."""
    possible = candidate_effects(load_model("swimmer"))
    return tuple(effect.id for effect in possible if not effect.needs_strained_start)


def _of_seed(seed: int, numerics: str, with_unlisted: bool) -> list[Case]:
    size = SIZES[seed % len(SIZES)]
    cases = [
        Case("nothing", (), 0.0, seed * NOTHING_PER_SEED + n, ("white", "coloured")[n % 2], numerics)
        for n in range(NOTHING_PER_SEED)
    ]
    beside = BESIDE_A_FAULT[seed % len(BESIDE_A_FAULT)]
    cases += [
        Case("set_up", (beside,) if beside else (), 1.0, seed, ("white", "coloured")[n % 2], numerics, fault)
        for n, fault in enumerate(FAULTS)
    ]
    for strong in STRONG:
        for n, identity in enumerate(listed_effects()):
            sign = -1.0 if seed % 2 and both_signs(identity) else 1.0
            colour = ("white", "coloured")[n % 2]
            cases.append(Case("strong", (identity,), sign * strong, seed, colour, numerics))
    shown = (
        *(("single", (identity,)) for identity in listed_effects()),
        *(("unlisted", (identity,)) for identity in UNLISTED if with_unlisted),
        *(("pair", pair) for pair in PAIRS[seed % 2 :: 2]),
    )
    for number, (kind, hidden) in enumerate(shown):
        sign = -1.0 if seed % 2 and kind != "pair" and both_signs(effect_source(hidden[0])) else 1.0
        colour = ("white", "coloured")[(seed + NOTHING_PER_SEED + number) % 2]
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
