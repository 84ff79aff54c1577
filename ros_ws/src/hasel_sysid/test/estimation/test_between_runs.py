"""Standard errors where the model is wrong in each run in its own way."""

import numpy as np
import pytest
from hasel_sysid.estimation.covariance import scatter_between_runs, wider_where_runs_disagree
from hasel_sysid.estimation.uncertainty import parameter_covariance
from hasel_sysid.noise.model import NoiseModel
from scipy.linalg import fractional_matrix_power

RUNS = np.repeat(np.arange(9), 200)
TIME = np.tile(np.arange(200) / 120.0, 9)
JACOBIAN = np.column_stack([np.sin(2 * np.pi * TIME), np.cos(2 * np.pi * TIME), np.exp(-TIME)])
NOISE = NoiseModel(white=2e-6, coloured=8e-6, correlation=0.93)


def solve(jacobian, residual):
    """Least squares."""
    return np.linalg.lstsq(jacobian, residual, rcond=None)[0]


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
