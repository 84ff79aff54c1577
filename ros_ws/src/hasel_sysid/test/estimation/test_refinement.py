"""Standard errors that hold what mesh and time step do."""

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sim.run import Simulation
from hasel_sysid.estimation.least_squares import fitted_result
from hasel_sysid.estimation.refinement import refinements, with_numerical_error
from hasel_sysid.problem import Evaluation

_NAMES = ("slope", "amplitude_4500")


@pytest.fixture
def fit():
    """Two parameters, each seen by frames of its own, in white noise of 0.01."""
    model = load_model("swimmer").with_levels([4500.0])
    jacobian = np.zeros((400, 2))
    jacobian[:200, 0], jacobian[200:, 1] = 2.0, 0.5
    residual = 0.01 * np.random.default_rng(3).normal(size=400)
    evaluation = Evaluation(
        model,
        _NAMES,
        (Simulation,),
        residual,
        jacobian,
        np.zeros(400, int),
        np.zeros(1),
        (np.ones(400, bool),),
    )
    return fitted_result(evaluation, 1)


def test_the_shift_by_a_finer_mesh_is_one_standard_error_more(fit):
    """A mesh that moves the series as 0.03 of a parameter would adds 0.03 in quadrature, to that parameter only."""
    by_noise = {name: fit.model.parameters[name].standard_error for name in _NAMES}
    wider = with_numerical_error(fit, {"mesh": 0.03 * fit.evaluation.jacobian[:, 0]})
    errors = {name: wider.model.parameters[name].standard_error for name in _NAMES}
    assert errors["slope"] == pytest.approx(np.hypot(by_noise["slope"], 0.03))
    assert errors["amplitude_4500"] == pytest.approx(by_noise["amplitude_4500"])


def test_mesh_and_time_step_add_as_squares(fit):
    """Two refinements that move a value by 0.03 and 0.04 are worth 0.05."""
    column = fit.evaluation.jacobian[:, 0]
    wider = with_numerical_error(fit, {"mesh": 0.03 * column, "time_step": -0.04 * column})
    by_noise = fit.model.parameters["slope"].standard_error
    assert wider.model.parameters["slope"].standard_error == pytest.approx(np.hypot(by_noise, 0.05))


def test_a_finer_mesh_is_finer_across_the_body_too():
    """The strain of a film that hangs slack changes through the thickness."""
    mesh = refinements(load_model("swimmer"))["mesh"].description.numerics
    coarse = load_model("swimmer").description.numerics
    assert mesh.mesh_density > coarse.mesh_density
    assert mesh.layers > coarse.layers


def test_where_the_drive_sweeps_the_curve_between_the_levels_is_as_uncertain_as_the_mesh():
    """The muscles are known at three voltages only, and a lag passes all others; without one that does not matter."""
    model = load_model("swimmer").with_levels([3500.0, 4500.0, 5500.0])
    assert set(refinements(model)) == {"mesh", "time_step"}
    found = refinements(model.with_effects("charging_lag"))
    assert found["amplitude_curve"].description.numerics.amplitude_curve == "power"
    again = refinements(found["amplitude_curve"])
    assert again["amplitude_curve"].description.numerics.amplitude_curve == "cubic"


def test_what_no_parameter_can_follow_adds_nothing(fit):
    """A change at right angles to all derivatives moves no value."""
    across = np.tile([1.0, -1.0], 200)
    wider = with_numerical_error(fit, {"mesh": across})
    assert wider.model.parameters["slope"].standard_error == pytest.approx(
        fit.model.parameters["slope"].standard_error
    )
