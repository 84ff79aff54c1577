"""What is added to a fit once it has converged."""

import numpy as np
from hasel_sim.model import load_model
from hasel_sysid.fit.least_squares import fitted_result
from hasel_sysid.problem import Evaluation


def test_a_parameter_that_is_no_longer_determined_keeps_no_standard_error():
    """An earlier fit's error says nothing of a value that these recordings do not show."""
    model = load_model("swimmer").with_levels([4500.0])
    model = model.with_values(model.values, {"slope": 0.01, "amplitude_4500": 0.001})
    jacobian = np.column_stack([np.ones(100), np.zeros(100)])
    residual = 0.003 * np.random.default_rng(0).normal(size=100)
    names = ("slope", "amplitude_4500")
    runs, frames = np.zeros(100, int), (np.ones(100, bool),)
    result = fitted_result(Evaluation(model, names, (), residual, jacobian, runs, np.zeros(1), frames), 1)
    assert result.undetermined == ("amplitude_4500",)
    assert result.model.parameters["amplitude_4500"].standard_error is None
    assert result.model.parameters["slope"].standard_error is not None
