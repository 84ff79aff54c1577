# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What holds for every effect of the muscle on its bench."""

import numpy as np
import pytest
from hasel_sim.muscle.effect import muscle_catalogue
from hasel_sim.muscle.muscle import Muscle
from numpy.testing import assert_array_equal

TIME = 0.1 * np.arange(300)
VOLTAGE = np.where(TIME % 10 < 5, 2000.0 + 150 * TIME, 0.0)
LOAD = np.where(TIME < 15, 0.4, 0.9)
EFFECTS = list(muscle_catalogue().values())


@pytest.fixture
def muscle(pouch):
    """Six of these pouches in series."""
    return Muscle("made up", pouch, 6)


def ids(effect):
    """What a test of it is called."""
    return effect.id


@pytest.mark.parametrize("effect", EFFECTS, ids=ids)
def test_null_is_nothing(effect, muscle):
    """At its null values the muscle is exactly the one without the effect."""
    expected = muscle.contraction(TIME, VOLTAGE, LOAD)
    assert_array_equal(muscle.with_effects(effect.id).contraction(TIME, VOLTAGE, LOAD), expected)


@pytest.mark.parametrize("effect", EFFECTS, ids=ids)
def test_typical_is_noticed(effect, muscle):
    """At its typical values it changes the contraction, where loads differ, by more than a micrometre."""
    values = {f"{effect.id}.{p.name}": p.typical for p in effect.parameters}
    changed = muscle.with_effects(effect.id).with_values(values).contraction(TIME, VOLTAGE, LOAD)
    assert np.abs(changed - muscle.contraction(TIME, VOLTAGE, LOAD)).max() > 1e-6


@pytest.mark.parametrize("effect", EFFECTS, ids=ids)
def test_it_says_what_it_is(effect):
    """Physics, equation, signature, citation; a plausible range with a source that holds null and typical."""
    assert all((effect.physics, effect.equation, effect.signature, effect.citation))
    for p in effect.parameters:
        assert p.lower <= p.typical <= p.upper and p.lower <= (p.typical if p.scan else p.null) <= p.upper
        assert p.source
