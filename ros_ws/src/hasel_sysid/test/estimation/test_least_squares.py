"""What is added to a fit once it has converged."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_sim.model import load_model, save_model
from hasel_sysid.estimation.least_squares import finished, fit_least_squares, fitted_result
from hasel_sysid.problem import Evaluation
from hasel_sysid.testing.made_up_runs import made_up_evaluation


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


def evaluated(model, names, residual, slopes):
    """A problem's answer for one run, whose series have these slopes by the parameters named."""
    jacobian, frames = np.column_stack([slopes[name] for name in names]), np.ones(len(residual), bool)
    runs = np.zeros(len(residual), int)
    return Evaluation(model, names, (), residual, jacobian, runs, np.zeros(1), (frames,))


class Growing:
    """Runs in which a time constant shows as its exponential, beside a stiffness that is right from the start."""

    def evaluate(self, model, names):
        """As of a problem's, at the model's values."""
        growth = np.exp(model.values[TIME])
        slopes = {STIFFNESS: 1e-5 * np.array([1.0, -1.0]), TIME: growth * np.ones(2)}
        residual = np.e - growth - (model.values[STIFFNESS] - 264e3) * slopes[STIFFNESS]
        return evaluated(model, names, residual, slopes)


STIFFNESS = "material.soft.youngs_modulus_pa"
TIME = "material_damping.retardation_time"


def far_start():
    """A beam whose stiffness is free and right, and whose time constant is far off."""
    model = load_model("beam").with_effects("material_damping").with_freed(STIFFNESS)
    model = replace(model, parameters={**model.parameters, TIME: replace(model.parameters[TIME], upper=10.0)})
    return model.with_values({TIME: 4.0})


def test_a_stiffness_in_pascal_does_not_end_the_fit_of_what_is_small_beside_it():
    """Steps of a second are short beside 264 kPa, and yet they are not the end."""
    found = fit_least_squares(Growing(), far_start(), drafts=False)
    assert found.converged
    assert found.model.values[TIME] == pytest.approx(1.0, rel=1e-3)


def test_a_fit_that_ran_out_of_simulations_says_so():
    """It has not converged."""
    found = fit_least_squares(Growing(), far_start(), most_evaluations=2, drafts=False)
    assert not found.converged


class Lagging:
    """Runs in which a lag of 0.01 s shows, and one below a millisecond does not."""

    def evaluate(self, model, names):
        """As of a problem's, at the model's values."""
        lag = model.values[TIME]
        left, noise = np.exp(-1e-3 / lag), 1e-5 * np.array([1.0, -2.0, 1.0])
        slopes = {STIFFNESS: 1e-6 * np.array([1.0, 0.0, -1.0]), TIME: 1e-3 / lag**2 * left * np.ones(3)}
        residual = np.exp(-0.1) - left + noise - (model.values[STIFFNESS] - 264e3) * slopes[STIFFNESS]
        return evaluated(model, names, residual, slopes)


def test_a_value_on_a_bound_where_nothing_shows_it_is_tried_again_from_its_typical_size():
    """Of a time far below a step there is no slope, and yet a larger one describes the runs."""
    model = load_model("beam").with_effects("material_damping").with_freed(STIFFNESS)
    lost = model.with_values({TIME: model.parameters[TIME].lower + 1e-9})
    assert lost.values[TIME] < 1e-6
    found = fit_least_squares(Lagging(), lost, drafts=False)
    assert found.model.values[TIME] == pytest.approx(0.01, rel=1e-3)


LEAST_BENDING = 282.4
"""Squares that the best fit of these runs leaves."""


class Bending:
    """Runs whose second series grows with the square of a time constant and stays far off: a fit creeps to its end."""

    def __init__(self, first: np.ndarray, second: np.ndarray, motion: float = 10.0):
        self.first, self.second, self.time = first, second, np.linspace(0.0, 6.2, 400)
        self.simulated = motion * np.sin(3 * self.time)

    def evaluate(self, model, names):
        """As of a problem's, at the model's values."""
        time = model.values[TIME]
        residual = (-0.03 - time) * self.first + (1.185 - 0.5 * time**2) * self.second
        slopes = {STIFFNESS: np.zeros(400), TIME: self.first + time * self.second}
        jacobian = np.column_stack([slopes[name] for name in names])
        return made_up_evaluation(residual[None], self.time, None, self.simulated, jacobian, names, model)


class Noted(Bending):
    """The same runs, and the time constants that were asked for."""

    def __init__(self):
        angle = np.linspace(0.0, 6.2, 400)
        super().__init__(np.cos(angle), np.sin(angle))
        self.asked: list[float] = []

    def evaluate(self, model, names):
        """As of a problem's, at the model's values."""
        self.asked.append(model.values[TIME])
        return super().evaluate(model, names)


@pytest.mark.parametrize("start", [0.0, 0.0013, 0.0065])
def test_no_point_is_simulated_twice(start):
    """On a bound, from where scipy moves a little away, and where a start over its scale times it is not the start."""
    problem = Noted()
    fit_least_squares(problem, far_start().with_values({TIME: start}), drafts=False)
    assert np.diff(np.sort(problem.asked)).min(initial=np.inf) > 1e-11


def test_what_was_broken_off_goes_on_from_where_it_is_known():
    """The end of the first fit is not simulated again."""
    problem = Noted()
    rough = fit_least_squares(problem, far_start(), tolerance=1e-3, drafts=False, roughly=True)
    before = len(problem.asked)
    finished(problem, rough, tolerance=1e-3)
    assert rough.model.values[TIME] not in problem.asked[before:]
    assert len(problem.asked) > before


def fits(problem):
    """To the end, and roughly."""
    return [
        fit_least_squares(problem, far_start(), tolerance=1e-3, drafts=False, roughly=roughly)
        for roughly in (False, True)
    ]


def test_a_rough_fit_ends_early_where_frames_share_what_is_left():
    """It says that it has not converged, and goes on to the end when asked to."""
    angle = np.linspace(0.0, 6.2, 400)
    problem = Bending(np.cos(angle), np.sin(angle))
    exact, rough = fits(problem)
    least = exact.evaluation.sum_of_squares
    assert exact.converged and not rough.converged
    assert rough.iterations < 0.7 * exact.iterations
    assert least < rough.evaluation.sum_of_squares < 1.01 * least
    end = finished(problem, rough, tolerance=1e-3)
    assert end.converged
    assert end.evaluation.sum_of_squares == pytest.approx(least, rel=1e-3)


def test_a_rough_fit_of_what_is_far_off_goes_to_the_end():
    """There, small steps do not tell how far they will lead."""
    angle = np.linspace(0.0, 6.2, 400)
    exact, rough = fits(Bending(np.cos(angle), np.sin(angle), motion=0.1))
    assert rough.converged
    assert rough.iterations == exact.iterations


def test_a_rough_fit_goes_to_the_end_where_every_frame_counts():
    """White noise tells models apart by all of its squares."""
    exact, rough = fits(Bending(*np.random.default_rng(0).normal(size=(2, 400))))
    assert rough.evaluation.sum_of_squares == pytest.approx(exact.evaluation.sum_of_squares, rel=1e-3)
    assert rough.iterations >= exact.iterations - 1


def test_a_fit_that_creeps_far_above_its_goal_is_broken_off():
    """It says that it has not converged, ends the sooner; beside what is near it goes to its end."""
    angle = np.linspace(0.0, 6.2, 400)
    problem = Bending(np.cos(angle), np.sin(angle))
    exact, lost, near = (
        fit_least_squares(problem, far_start(), tolerance=1e-3, drafts=False, goal=share * LEAST_BENDING)
        for share in (0.0, 4e-6, 2.0)
    )
    least = exact.evaluation.sum_of_squares
    assert least == pytest.approx(LEAST_BENDING, rel=0.01)
    assert exact.converged and near.converged and not lost.converged
    assert lost.iterations < 0.7 * exact.iterations and near.iterations == exact.iterations
    assert least < lost.evaluation.sum_of_squares < 1.2 * least
    assert finished(problem, lost, tolerance=1e-3).evaluation.sum_of_squares == pytest.approx(least, rel=1e-3)
