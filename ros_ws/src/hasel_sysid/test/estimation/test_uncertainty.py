"""Standard errors against an independent library and against many repeated fits."""

import numpy as np
import pytest
import statsmodels.api as sm
from hasel_sysid.estimation.uncertainty import parameter_covariance
from hasel_sysid.noise.model import NoiseModel

RUNS = np.repeat(np.arange(4), 300)
TIME = np.tile(np.arange(300) / 120.0, 4)
JACOBIAN = np.column_stack([np.sin(2 * np.pi * TIME), np.cos(2 * np.pi * TIME), np.exp(-TIME)])


def test_white_noise_gives_the_textbook_covariance():
    """It agrees with ordinary least squares of statsmodels."""
    generator = np.random.default_rng(0)
    residual = generator.normal(scale=0.003, size=len(TIME))
    reference = sm.OLS(residual, JACOBIAN).fit()
    noise = NoiseModel(white=float(reference.scale), coloured=0.0, correlation=0.5)
    covariance, undetermined = parameter_covariance(JACOBIAN, noise, RUNS)
    np.testing.assert_allclose(covariance, reference.cov_params(), rtol=1e-8)
    assert not undetermined.any()


def test_intervals_cover_the_truth_under_correlated_noise():
    """95 % intervals cover 90 to 98 %, where those that take frames for independent cover far less."""
    noise = NoiseModel(white=2e-6, coloured=8e-6, correlation=0.93)
    draws = noise.sample(RUNS, 400, np.random.default_rng(1))
    estimates = np.linalg.lstsq(JACOBIAN, draws, rcond=None)[0]
    covered, naive = [], []
    for model, result in ((noise, covered), (NoiseModel(noise.white + noise.coloured, 0.0, 0.5), naive)):
        covariance, _ = parameter_covariance(JACOBIAN, model, RUNS)
        result.append(np.mean(np.abs(estimates) <= 1.96 * np.sqrt(np.diag(covariance))[:, None]))
    assert 0.90 <= covered[0] <= 0.98
    assert naive[0] < 0.75


def test_directions_that_nothing_shows_are_undetermined():
    """Two parameters of which only the sum acts, and one that does nothing, have no finite error."""
    jacobian = np.column_stack([JACOBIAN[:, 0], JACOBIAN[:, 0], JACOBIAN[:, 1], np.zeros(len(TIME))])
    covariance, undetermined = parameter_covariance(jacobian, NoiseModel(1e-5, 0.0, 0.5), RUNS)
    assert undetermined.tolist() == [True, True, False, True]
    assert np.isfinite(covariance[2, 2])
    assert np.isinf(covariance[0, 0])


def test_scale_of_a_parameter_does_not_matter():
    """A parameter in pascals and one without unit side by side keep their precision."""
    noise = NoiseModel(1e-5, 0.0, 0.5)
    plain, _ = parameter_covariance(JACOBIAN, noise, RUNS)
    scaled, _ = parameter_covariance(JACOBIAN * [1e-9, 1.0, 1e6], noise, RUNS)
    assert scaled[0, 0] == pytest.approx(plain[0, 0] * 1e18, rel=1e-6)
