# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What `hidden` says, and the swimmer that comes of it."""

import numpy as np
import pytest
from hasel_bringup.errors import BringupError
from hasel_bringup.hidden_truth.hidden import hidden_values, hideable, with_hidden
from hasel_sim.effects.registry import catalogue
from hasel_sim.errors import ModelError
from hasel_sim.model import load_model


@pytest.fixture
def swimmer():
    """The default swimmer with one amplitude."""
    return load_model("swimmer").with_levels(np.array([5500.0]))


def said(*words: str) -> dict[str, float]:
    """The values that these words stand for."""
    return hidden_values(words, np.random.default_rng(1))


def test_effects_and_values_are_taken_over(swimmer):
    """An effect is added once; a baseline parameter can be set too."""
    values = said("charging_lag.charge_time=0.07", "charging_lag.discharge_time=0.05", "slope=0.4")
    model = with_hidden(swimmer, values)
    assert [effect.id for effect in model.effects] == ["charging_lag"]
    assert {name: model.values[name] for name in values} == values
    assert values["slope"] == 0.4


def test_an_effect_alone_has_about_its_typical_size():
    """Within a tenth; of several each, and of none nothing."""
    values = said("quadratic_drag", "added_mass")
    typical = catalogue()["quadratic_drag"].typical()["coefficient"]
    assert values["quadratic_drag.coefficient"] == pytest.approx(typical, rel=0.11)
    assert any(name.startswith("added_mass.") for name in values)
    assert said("none") == {}


def test_random_is_an_effect_that_moves_the_body():
    """Another one by another seed, the same by the same."""
    drawn = [hidden_values(["random"], np.random.default_rng(seed)) for seed in (*range(8), 0)]
    effects = [next(iter(values)).split(".")[0] for values in drawn]
    assert set(effects) <= set(hideable())
    assert len(set(effects)) > 1
    assert drawn[0] == drawn[-1]


@pytest.mark.parametrize(
    ("word", "expected"),
    [
        ("quadratic_drag.coefficient=much", "a number behind '='"),
        ("quadratic_drug.coefficient=1", "quadratic_drag"),
        ("quadratic_drug", "quadratic_drag"),
        ("camera_latency", "moves the body"),
    ],
)
def test_a_word_that_says_nothing_is_refused(word, expected):
    """In one sentence that says what was expected."""
    with pytest.raises(BringupError, match=expected):
        said(word)


@pytest.mark.parametrize(
    ("word", "expected"),
    [
        ("quadratic_drag.coeficient=1", "quadratic_drag.coefficient"),
        ("quadratic_drag.coefficient=-1", "= -1 is out of range"),
    ],
)
def test_a_value_that_no_swimmer_has_is_refused(swimmer, word, expected):
    """Likewise."""
    with pytest.raises(ModelError, match=expected):
        with_hidden(swimmer, said(word))
