# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The page's tables say what the code does."""

import re
from pathlib import Path

from hasel_benchmark.bench_hidden.hidden_cases import NOTHING_PER_SEED, list_cases
from hasel_benchmark.bench_hidden.unlisted_effects import UNLISTED
from hasel_benchmark.benchmark_commands import BODIES, DISCRETISATIONS, KINDS, SIZES
from hasel_bringup.hidden_truth.truth import NUMERICS
from hasel_sim.effects.registry import find_effects

PACKAGE = Path(__file__).resolve().parents[1]
DOCS = Path(__file__).resolve().parents[4] / "docs"
PAGE = (DOCS / "results/benchmark.md").read_text(encoding="utf-8")


def rows(header):
    """Cells of the table whose first header is this."""
    table = re.search(rf"^\| {re.escape(header)}.*\n\|[-|]+\n((?:\|.*\n)+)", PAGE, flags=re.M)[1]
    return [tuple(cell.strip(" `") for cell in line.strip("|").split("|")) for line in table.splitlines()]


def test_commands_are_listed():
    """Exactly the executables of the package."""
    executables = re.findall(r'"(\w+) = hasel_benchmark', (PACKAGE / "setup.py").read_text(encoding="utf-8"))
    assert executables
    assert sorted(name for name, _ in rows("command")) == sorted(executables)


def test_kinds_are_those_of_the_cases():
    """Each with its word on the command line, and as many per seed as are listed."""
    assert {only: kind for kind, only, *_ in rows("kind of case")} == KINDS
    cases = list_cases(tuple(KINDS.values()), range(5), (), "near")
    assert sum(case.kind == "nothing" for case in cases) == 5 * NOTHING_PER_SEED
    assert ("nothing", f"{NOTHING_PER_SEED}") in [(row[0], row[-1]) for row in rows("kind of case")]
    assert [sum(c.kind == "pair" and c.seed == s for c in cases) for s in range(5)] == [5] * 5
    assert {c.seed for c in cases if c.kind == "unlisted"} == {0, 1, 2}


def test_truths_are_those_of_the_code():
    """Discretisation by discretisation."""
    assert rows("truth") == [
        (n.name, *(f"{v:g}" for v in (n.mesh_density, n.layers, n.steps_per_second, n.spectral_radius)))
        for n in NUMERICS.values()
    ]
    assert set(NUMERICS) == set(DISCRETISATIONS)


def test_unlisted_effects_are_explained():
    """Each in its class's own first sentence."""
    said = {
        name: type(find_effects((source,))[0]).__doc__.splitlines()[0] for name, source in UNLISTED.items()
    }
    assert dict(rows("unlisted effect")) == said


def test_constants_are_those_that_are_set_wrong():
    """All of them, with bodies that there are."""
    listed = dict(rows("constant"))
    assert set(listed) == set(SIZES.values())
    assert {body for names in listed.values() for body in names.split(", ")} == set(BODIES)
