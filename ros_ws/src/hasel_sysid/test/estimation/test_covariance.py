# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Standard errors: by noise (sandwich), by runs that disagree (CR2), and by the discretisation (type B)."""

import numpy as np
import pytest
import statsmodels.api as sm
from hasel_sim.model import load_model
from hasel_sysid.estimation.covariance import (
    parameter_covariance,
    scatter_between_runs,
    seen_directions,
    wider_where_runs_disagree,
    with_numerical_error,
)
from hasel_sysid.noise import NoiseModel
from hasel_sysid.problem import Evaluation, refinements
from hasel_sysid.testing.made_up_runs import made_up_evaluation
from scipy.linalg import fractional_matrix_power

RUNS = np.repeat(np.arange(9), 200)
TIME = np.tile(np.arange(200) / 120.0, 9)
JACOBIAN = np.column_stack([np.sin(2 * np.pi * TIME), np.cos(2 * np.pi * TIME), np.exp(-TIME)])
NOISE = NoiseModel(white=2e-6, coloured=8e-6, correlation=0.93)
COLUMNS = np.random.default_rng(0).normal(size=(50, 3))


def solve(jacobian, residual):
    """Least squares."""
    return np.linalg.lstsq(jacobian, residual, rcond=None)[0]


def test_white_noise_gives_the_textbook_covariance():
    """It agrees with ordinary least squares of statsmodels."""
    residual = np.random.default_rng(0).normal(scale=0.003, size=len(TIME))
    reference = sm.OLS(residual, JACOBIAN).fit()
    noise = NoiseModel(white=float(reference.scale), coloured=0.0, correlation=0.5)
    covariance, undetermined = parameter_covariance(JACOBIAN, noise, RUNS)
    np.testing.assert_allclose(covariance, reference.cov_params(), rtol=1e-8)
    assert not undetermined.any()


def test_intervals_cover_the_truth_under_correlated_noise():
    """95 % intervals cover 90 to 98 %, where those that take frames for independent cover far less."""
    draws = NOISE.sample(RUNS, 400, np.random.default_rng(1))
    estimates = solve(JACOBIAN, draws)
    covered = []
    for model in (NOISE, NoiseModel(NOISE.white + NOISE.coloured, 0.0, 0.5)):
        covariance, _ = parameter_covariance(JACOBIAN, model, RUNS)
        covered.append(np.mean(np.abs(estimates) <= 1.96 * np.sqrt(np.diag(covariance))[:, None]))
    assert 0.90 <= covered[0] <= 0.98
    assert covered[1] < 0.75


def test_directions_that_nothing_shows_are_undetermined():
    """Two parameters of which only the sum acts, and one that does nothing, have no finite error."""
    jacobian = np.column_stack([JACOBIAN[:, 0], JACOBIAN[:, 0], JACOBIAN[:, 1], np.zeros(len(TIME))])
    covariance, undetermined = parameter_covariance(jacobian, NOISE, RUNS)
    assert undetermined.tolist() == [True, True, False, True]
    assert np.isfinite(covariance[2, 2])
    assert np.isinf(covariance[0, 0])


def test_scale_of_a_parameter_does_not_matter():
    """A parameter in pascals and one without unit side by side keep their precision."""
    plain, _ = parameter_covariance(JACOBIAN, NOISE, RUNS)
    scaled, _ = parameter_covariance(JACOBIAN * [1e-9, 1.0, 1e6], NOISE, RUNS)
    assert scaled[0, 0] == pytest.approx(plain[0, 0] * 1e18, rel=1e-6)


def test_an_estimate_is_least_squares():
    """It agrees with numpy's solver, whatever the units; what nothing shows does not move."""
    change = np.random.default_rng(1).normal(size=50)
    expected = solve(COLUMNS, change) / [1e-9, 1.0, 1e6]
    seen = seen_directions(np.column_stack([COLUMNS * [1e-9, 1.0, 1e6], np.zeros(50)]))
    np.testing.assert_allclose(seen.estimate(change), [*expected, 0.0], rtol=1e-9)
    none = seen_directions(np.zeros((50, 0)))
    assert none.left.shape == (50, 0) and none.estimate(change).shape == (0,)


def coverage(residuals):
    """How often 95 % intervals cover the truth, zero: by noise alone, and by noise and scatter."""
    covariance, _ = parameter_covariance(JACOBIAN, NOISE, RUNS)
    by_noise = np.sqrt(np.diag(covariance))
    alone, both = [], []
    for residual in residuals.T:
        estimate = solve(JACOBIAN, residual)
        left = residual - JACOBIAN @ estimate
        alone.append(np.abs(estimate) <= 1.96 * by_noise)
        wider = wider_where_runs_disagree(by_noise, JACOBIAN, left, RUNS)
        both.append(np.abs(estimate) <= 1.96 * wider)
    return np.mean(alone), np.mean(both)


def test_it_is_the_formula_of_bell_and_mccaffrey():
    """The same as with the square root of I - H taken of whole matrices."""
    residual = NOISE.sample(RUNS, 1, np.random.default_rng(0))[:, 0]
    left = residual - JACOBIAN @ solve(JACOBIAN, residual)
    inverse = np.linalg.inv(JACOBIAN.T @ JACOBIAN)
    middle = np.zeros((3, 3))
    for run in range(9):
        own = JACOBIAN[run == RUNS]
        adjusted = (
            fractional_matrix_power(np.eye(len(own)) - own @ inverse @ own.T, -0.5).real @ left[run == RUNS]
        )
        middle += np.outer(own.T @ adjusted, own.T @ adjusted)
    expected = np.sqrt(np.diag(inverse @ middle @ inverse))
    np.testing.assert_allclose(scatter_between_runs(JACOBIAN, left, RUNS), expected, rtol=1e-9)


def test_intervals_cover_the_truth_under_noise():
    """Where the model is right, the scatter between nine runs hardly ever takes over."""
    alone, both = coverage(NOISE.sample(RUNS, 300, np.random.default_rng(1)))
    assert 0.90 <= alone <= both <= 0.98


def test_intervals_cover_the_truth_where_every_run_has_an_error_of_its_own():
    """Gains that differ from run to run by more than the noise are not told by the noise."""
    generator = np.random.default_rng(2)
    gains = generator.normal(scale=0.004, size=(9, 3, 300))
    wrong = np.einsum("fp,fps->fs", JACOBIAN, gains[RUNS])
    alone, both = coverage(NOISE.sample(RUNS, 300, generator) + wrong)
    assert alone < 0.8
    assert 0.90 <= both <= 0.98


def test_too_few_runs_say_nothing():
    """Of three runs, or of a parameter that one run alone determines, there is no scatter."""
    residual = np.random.default_rng(3).normal(size=len(TIME))
    few = RUNS < 3
    assert np.isnan(scatter_between_runs(JACOBIAN[few], residual[few], RUNS[few])).all()
    alone = np.column_stack([JACOBIAN, np.where(RUNS == 0, JACOBIAN[:, 0], 0.0)])
    assert np.isfinite(scatter_between_runs(alone, residual, RUNS)).tolist() == [True, True, True, False]
    assert wider_where_runs_disagree(np.ones(4), alone, residual, RUNS)[3] == pytest.approx(1.0)


@pytest.fixture
def evaluation() -> Evaluation:
    """Two parameters, each seen by frames of its own."""
    jacobian = np.zeros((400, 2))
    jacobian[:200, 0], jacobian[200:, 1] = 2.0, 0.5
    model = load_model("swimmer").with_levels([4500.0])
    names = ("slope", "amplitude_4500")
    return made_up_evaluation(np.zeros((1, 400)), np.arange(400) / 120, None, None, jacobian, names, model)


def test_the_shift_by_finer_numerics_is_one_standard_error_more(evaluation):
    """Of type B: mesh and time step that shift one estimate by 0.03 and 0.04 add as squares, to that estimate only."""
    by_noise, column = np.diag([0.02**2, 0.01**2]), evaluation.jacobian[:, 0]
    changes = {"mesh": 0.03 * column, "time_step": -0.04 * column}
    errors = np.sqrt(np.diag(with_numerical_error(evaluation, by_noise, changes)))
    assert errors == pytest.approx([np.hypot(0.02, 0.05), 0.01])


def test_what_no_parameter_can_follow_adds_nothing(evaluation):
    """A change at right angles to all derivatives moves no value."""
    across = {"mesh": np.tile([1.0, -1.0], 200)}
    assert with_numerical_error(evaluation, np.eye(2), across) == pytest.approx(np.eye(2))


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
