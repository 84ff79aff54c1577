# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Copies of a model with changes."""

import numpy as np
import pytest
from hasel_sim.errors import ModelError
from hasel_sim.model import load_model


def test_levels_keep_known_amplitudes_and_drop_others(swimmer):
    """One amplitude per voltage, ascending."""
    model = swimmer.with_levels(np.array([5500.0, 3500.0]))
    assert model.levels.tolist() == [3500.0, 5500.0]
    assert model.values["amplitude_5500"] == swimmer.values["amplitude_5500"]
    assert model.with_levels(np.array([3500.0])).levels.tolist() == [3500.0]


def test_changes_leave_the_model_itself_alone(swimmer):
    """Every copy is a new model."""
    before = dict(swimmer.values)
    swimmer.with_values({"slope": 9.0}).with_effects("quadratic_drag").with_numerics(mesh_density=2.0)
    assert swimmer.values == before
    assert not swimmer.effects


def test_an_effect_brings_its_parameters_at_null_and_takes_them_away(swimmer):
    """With and without are inverse."""
    model = swimmer.with_effects("quadratic_drag")
    names = [name for name in model.parameters if name.startswith("quadratic_drag.")]
    assert names
    assert all(model.values[name] == 0.0 for name in names)
    assert model.without_effects("quadratic_drag") == swimmer


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (lambda m: m.with_values({"slop": 1.0}), "the nearest known one is 'slope'"),
        (lambda m: m.with_effects("quadratic_drag", "quadratic_drag"), "is there twice"),
        (lambda m: m.without_effects("quadratic_drag"), "is not in model 'swimmer'"),
    ],
)
def test_what_cannot_be_is_refused(change, expected, swimmer):
    """With one sentence."""
    with pytest.raises(ModelError, match=expected):
        change(swimmer)


def test_what_is_held_keeps_its_value_and_is_not_fitted(swimmer):
    """The others stay free; a name that is no parameter is refused."""
    held = swimmer.with_held("slope")
    assert held.values == swimmer.values
    assert set(swimmer.free) - set(held.free) == {"slope"}
    with pytest.raises(ModelError, match="slop"):
        swimmer.with_held("slop")


def test_an_effect_of_the_muscles_is_refused_on_a_body_without():
    """The beam has none."""
    with pytest.raises(ModelError, match="acts on the muscles"):
        load_model("beam").with_effects("charging_lag")


def test_a_parameter_prints_with_its_error_and_unit(swimmer):
    """As in a report."""
    model = swimmer.with_values({"slope": 0.264}, {"slope": 0.0123})
    assert str(model.parameters["slope"]) == "slope = 0.264 ± 0.012 1/s"
