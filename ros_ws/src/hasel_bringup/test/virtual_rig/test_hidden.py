"""Settings of the truth."""

import numpy as np
import pytest
from hasel_bringup.virtual_rig.hidden import with_hidden
from hasel_sim.errors import ModelError
from hasel_sim.model import load_model


@pytest.fixture
def swimmer():
    """The default swimmer with one amplitude."""
    return load_model("swimmer").with_levels(np.array([5500.0]))


def test_effects_and_values_are_taken_over(swimmer):
    """An effect is added once; a baseline parameter can be set too."""
    model = with_hidden(
        swimmer, ["charging_lag.charge_time=0.07", "charging_lag.discharge_time=0.05", "slope=0.4"]
    )
    assert [effect.id for effect in model.effects] == ["charging_lag"]
    assert model.values["charging_lag.charge_time"] == 0.07
    assert model.values["charging_lag.discharge_time"] == 0.05
    assert model.values["slope"] == 0.4


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("quadratic_drag", "name=value"),
        ("quadratic_drag.coefficient=much", "name=value"),
        ("quadratic_drug.coefficient=1", "quadratic_drag"),
        ("quadratic_drag.coeficient=1", "quadratic_drag.coefficient"),
        ("quadratic_drag.coefficient=-1", "out of range"),
    ],
)
def test_a_mistake_is_one_sentence(swimmer, setting, words):
    """It says what was expected."""
    with pytest.raises(ModelError, match=words):
        with_hidden(swimmer, [setting])
