# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The page's tables are those of the code."""

import re
from pathlib import Path

from hasel_muscle.bench_recording import QUANTITIES
from hasel_sim.muscle.effect import muscle_catalogue

DOCS = Path(__file__).resolve().parents[4] / "docs"
PAGE = (DOCS / "how_to/muscle.md").read_text(encoding="utf-8")


def test_effects_of_the_muscle_are_those_of_the_catalogue():
    """Every one with its equation, and no other."""
    rows = re.findall(
        r"^\| `(\w+)` \| (.*?) \| (?:voltage|pouch|force|contraction(?:, in time)?) \|$", PAGE, re.M
    )
    assert rows == [(name, effect.equation) for name, effect in muscle_catalogue().items()]


def test_columns_of_a_bench_are_those_that_are_read():
    """Every quantity, with all the units that its column may end in."""
    section = PAGE.split("| effect of the muscle")[0]
    for quantity, units in QUANTITIES.items():
        (row,) = re.findall(rf"^\| `{quantity}_(.*)$", section, re.M)
        named = {row.split("`")[0], *re.findall(r"`_(\w+)`", row)}
        assert named == set(units), quantity
