"""How far a single step goes."""

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sysid.diagnosis.step import bounded_step, room

SHARE, TIME = "initial_relaxation.share", "initial_relaxation.relaxation_time"


def test_a_size_may_go_anywhere_within_its_range_and_a_time_by_half_of_itself():
    """Derivatives say nothing of a time ten times as long."""
    model = load_model("beam").with_effects("initial_relaxation").with_values({SHARE: 0.1, TIME: 2.0})
    down, up = room(model, (SHARE, TIME))
    share = model.parameters[SHARE]
    assert [down[0], up[0]] == pytest.approx([share.lower - 0.1, share.upper - 0.1])
    assert [down[1], up[1]] == pytest.approx([-1.0, 1.0])


def test_a_step_is_that_of_least_squares_where_there_is_room():
    """Where there is none, it ends at the end of the range, and the squares there are said."""
    model = load_model("swimmer").with_effects("linear_drag").with_values({"linear_drag.rate": 1.0})
    slope, names = np.array([[1.0], [2.0]]), ("linear_drag.rate",)
    step, squares = bounded_step(model, names, np.array([0.5, 1.0]), slope)
    assert step == {"linear_drag.rate": pytest.approx(1.5)} and squares == pytest.approx(0.0, abs=1e-12)
    step, squares = bounded_step(model, names, np.array([-2.0, -4.0]), slope)
    assert step == {"linear_drag.rate": pytest.approx(0.0)} and squares == pytest.approx(5.0)
