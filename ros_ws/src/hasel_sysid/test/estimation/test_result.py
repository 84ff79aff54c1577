"""What a fit says of its parameters."""

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sysid.estimation import FittedModel
from hasel_sysid.problem import Evaluation


@pytest.mark.parametrize(
    ("value", "sentence"),
    [
        (
            0.0,
            "quadratic_drag.coefficient is at 0: these recordings ask for none of it, or something else is missing.",
        ),
        (
            10.0,
            "quadratic_drag.coefficient is at its upper bound, 10: something else is missing, or the bound is too "
            "tight.",
        ),
    ],
)
def test_a_value_on_a_bound_is_said(value, sentence):
    """With the bound; that nothing is asked for is no bound that is too tight."""
    model = (
        load_model("swimmer")
        .with_effects("quadratic_drag")
        .with_values({"quadratic_drag.coefficient": value})
    )
    names = ("quadratic_drag.coefficient",)
    nothing = np.zeros(0)
    evaluation = Evaluation(model, names, (), nothing, np.zeros((0, 1)), nothing, nothing, ())
    assert FittedModel(model, evaluation, names, (), 1, "least squares").sentences == [sentence]
