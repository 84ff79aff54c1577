# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Which words are units."""

import pytest
from hasel_sim.effects.check_tools import is_unit
from hasel_sim.effects.registry import catalogue


@pytest.mark.parametrize(
    "text", ["1", "s", "kg/m^3", "N s/m", "Pa·s", "1/(V s)", "m s^-1", "m²", "kPa", "1/V^2"]
)
def test_units_are_units(text):
    """Products, quotients and powers of SI units."""
    assert is_unit(text)


@pytest.mark.parametrize("text", ["bananas", "", "volt", "kg per m"])
def test_other_words_are_none(text):
    """Whatever else a user may write."""
    assert not is_unit(text)


def test_the_catalogue_has_units():
    """Every parameter of every built-in effect."""
    assert all(is_unit(p.unit) for effect in catalogue().values() for p in effect.parameters)
