"""What is added to a fit once it has converged."""

import numpy as np
import pytest
from hasel_sim.model import load_model, save_model
from hasel_sysid.fit.least_squares import fitted_result
from hasel_sysid.problem import Evaluation


def test_the_covariance_of_a_fit_goes_with_its_model(tmp_path):
    """Two parameters that do nearly the same: their errors have a correlation near -1, in the model and in its file."""
    model = load_model("swimmer").with_levels([4500.0])
    rng = np.random.default_rng(2)
    one = rng.normal(size=2000)
    jacobian = np.column_stack([one, one + 0.1 * rng.normal(size=2000)])
    residual = 0.003 * rng.normal(size=2000)
    names, runs = ("slope", "amplitude_4500"), np.zeros(2000, int)
    evaluation = Evaluation(model, names, (), residual, jacobian, runs, np.zeros(1), (np.ones(2000, bool),))
    found = fitted_result(evaluation, 1).model
    expected = 0.003**2 * np.linalg.inv(jacobian.T @ jacobian)
    assert found.covariance(names) == pytest.approx(expected, rel=0.2)
    save_model(found, tmp_path / "fitted.yaml")
    again = load_model(tmp_path / "fitted.yaml")
    assert again.covariance(names) == pytest.approx(found.covariance(names))
    assert again.covariance(names[::-1])[0, 1] == pytest.approx(found.covariance(names)[0, 1])
    assert again.covariance(names)[0, 1] < -0.98 * np.sqrt(np.prod(np.diag(again.covariance(names))))
    anew = again.with_values({"slope": 0.3}, {"slope": 0.01})
    assert anew.covariance(names)[0, 1] == 0.0
    assert again.with_values({"slope": 0.3}).covariance(names)[0, 1] < 0.0


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
