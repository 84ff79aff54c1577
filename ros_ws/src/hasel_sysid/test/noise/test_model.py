"""The noise model against series whose noise is known."""

import numpy as np
import pytest
from hasel_sysid.noise.model import NoiseModel, estimate_noise

RUNS = np.repeat(np.arange(6), 400)
TRUTH = NoiseModel(white=6e-6, coloured=3e-6, correlation=0.9)


def test_samples_have_the_stated_covariance():
    """Products with the covariance agree with the average over many drawn series."""
    series = TRUTH.sample(RUNS, 400, np.random.default_rng(0))
    direction = np.zeros((len(RUNS), 1))
    direction[10:30, 0] = 1.0
    predicted = float((direction.T @ TRUTH.covariance_product(direction, RUNS))[0, 0])
    assert np.var(direction[:, 0] @ series) == pytest.approx(predicted, rel=0.25)


def test_white_and_coloured_parts_are_told_apart():
    """Whittle's likelihood finds both variances and the memory within a fifth."""
    residual = TRUTH.sample(RUNS, 1, np.random.default_rng(1))[:, 0]
    found = estimate_noise(residual, RUNS, np.zeros((len(RUNS), 0)), "a test")
    assert found.white == pytest.approx(TRUTH.white, rel=0.2)
    assert found.coloured == pytest.approx(TRUTH.coloured, rel=0.35)
    assert found.correlation == pytest.approx(TRUTH.correlation, abs=0.06)


def test_fitted_directions_are_accounted_for():
    """Slow directions taken out of the residual do not make the noise look smaller."""
    time = np.tile(np.linspace(0, 1, 400), 6)
    fitted = np.column_stack(
        [np.cos(np.pi * k * time) * (run == RUNS) for k in range(1, 6) for run in range(6)]
    )
    basis = np.linalg.qr(fitted)[0]
    errors = []
    for seed in range(5):
        residual = TRUTH.sample(RUNS, 1, np.random.default_rng(seed))[:, 0]
        left = residual - basis @ (basis.T @ residual)
        errors.append(
            estimate_noise(left, RUNS, fitted, "a test").standard_deviation / TRUTH.standard_deviation
        )
    assert np.mean(errors) == pytest.approx(1.0, abs=0.08)


def test_mean_absolute_is_that_of_normal_noise():
    """The noise floor is in the unit of the error table: mean |noise|."""
    series = TRUTH.sample(RUNS, 50, np.random.default_rng(3))
    assert TRUTH.mean_absolute == pytest.approx(np.abs(series).mean(), rel=0.03)
