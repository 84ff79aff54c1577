"""By which sum of squares an effect is judged."""

import numpy as np
import pytest
from hasel_sim.effects.registry import catalogue
from hasel_sim.model import load_model
from hasel_sysid.candidates import starts
from hasel_sysid.diagnosis.reached import squares_reached
from hasel_sysid.testing.made_up_runs import made_up_fit, made_up_trial

BEAM, BASE = load_model("beam"), 10.0


def trial(effect: str, predicted: float, promised: float):
    """A trial with a sum of squares of 9 that would come to `predicted` with its next step."""
    (start,) = starts(catalogue()[effect])
    return made_up_trial(BEAM, start, start.values, np.array([3.0]), np.array([[1.0]]), predicted, promised)


@pytest.fixture
def tried():
    """Two trials that come near to what they reach, and promised more."""
    return [trial("linear_drag", 5.0, 9.5), trial("material_damping", 3.0, 8.0)]


@pytest.fixture
def fitted():
    """The one that was fitted in full, to a sum of squares of 2."""
    return {"material_damping": made_up_fit(BEAM.with_effects("material_damping"), error=1.0)}


def test_with_time_for_everything_each_is_judged_by_what_it_reached(tried, fitted):
    """A promise that was not kept says nothing."""
    assert squares_reached(tried, fitted, BASE, False) == {"linear_drag": 5.0, "material_damping": 2.0}


def test_what_had_no_turn_is_judged_by_what_it_promises(tried, fitted):
    """The one that was fitted in full is judged by its fit, and is not surely the one that is missing."""
    assert squares_reached(tried, fitted, BASE, True) == {"linear_drag": 0.5, "material_damping": 2.0}
