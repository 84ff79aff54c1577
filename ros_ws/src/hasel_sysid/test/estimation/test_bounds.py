"""Which fitted parameters a bound holds back."""

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sysid.estimation.bounds import at_bound, further_without_bounds
from hasel_sysid.problem import Evaluation

NAME = "material.soft.retardation_time_s"
UPPER = load_model("arm").parameters[NAME].upper
SERIES = np.sin(np.linspace(0.0, 6.0, 50))


def ended(value, pull):
    """A fit that ended at a value, while the runs ask for so much more of it."""
    model = load_model("arm").with_values({NAME: value})
    runs = np.zeros(len(SERIES), dtype=int)
    return Evaluation(model, (NAME,), (), pull * SERIES, SERIES[:, None], runs, np.zeros(1), ())


@pytest.mark.parametrize(
    ("value", "pull", "held"),
    [
        (UPPER, 0.0, True),
        (0.995 * UPPER, 0.1 * UPPER, True),
        (0.995 * UPPER, -0.1 * UPPER, False),
        (0.995 * UPPER, 0.001 * UPPER, False),
        (0.5 * UPPER, UPPER, False),
    ],
    ids=["on it", "on the way to it", "on the way from it", "near it and at rest", "far from it"],
)
def test_what_is_on_its_way_to_a_bound_is_held_by_it(value, pull, held):
    """Rounding decides how near to a bound a search ends, and not whether the bound holds the parameter."""
    assert at_bound(ended(value, pull)) == ((NAME,) if held else ())


@pytest.mark.parametrize("pull", [-0.1, 0.0, 0.1])
def test_without_its_bounds_a_parameter_goes_where_the_runs_ask_for_it(pull):
    """Beyond them, back into its range, or nowhere."""
    assert further_without_bounds(ended(UPPER, pull * UPPER), NAME) == pytest.approx(pull * UPPER)
