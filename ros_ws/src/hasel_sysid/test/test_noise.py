# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The noise model against series whose noise is known."""

import numpy as np
import pytest
from hasel_recording import Recording
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.run import Run
from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import Experiment
from hasel_sysid.noise import NoiseModel, estimate_noise, given_noise, measured_noise

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


TIME = np.arange(-0.5, 4.0, 0.01)
FAINT = NoiseModel(white=4e-10, coloured=0.0, correlation=0.5)


def noise(seed, truth=FAINT):
    """One series of it."""
    return truth.sample(np.zeros(len(TIME), int), 1, np.random.default_rng(seed))[:, 0]


def swing(released, initial_time, seed=0, truth=FAINT):
    """A body at rest that is let go by hand at `released` [s]; the model is to start later, at `initial_time` [s]."""
    since = np.clip(TIME - released, 0.0, None)
    angle = -0.1 * (1 - np.exp(-2 * since) * np.cos(25 * since)) + noise(seed, truth)
    run = Run("swing", TIME, None, "static_equilibrium", 1.5, initial_time)
    return Experiment(Recording("swing", TIME, angle), run)


def driven(first, seed, amplitude=0.1):
    """A body whose first muscle is switched on at `first` [s]."""
    voltage = DriveSchedule(np.array([-0.5, first]), np.array([[0.0, 0.0], [4000.0, 0.0]]))
    angle = np.where(first < TIME, amplitude * (1 - np.exp(-4 * (TIME - first))), 0.0) + noise(seed)
    return Experiment(Recording("driven", TIME, angle), Run("driven", TIME, voltage))


@pytest.mark.parametrize("seed", range(4))
def test_rest_before_the_start_shows_the_noise_not_the_release_by_hand(seed):
    """The frames between the hand's release and the model's start belong to the motion."""
    found = measured_noise([swing(released=0.0, initial_time=0.13, seed=seed)])
    assert found.standard_deviation == pytest.approx(FAINT.standard_deviation, rel=0.4)
    assert not found.upper_bound and "at rest" in found.source


def test_noise_that_neighbouring_frames_share_is_seen_at_rest_too():
    """Pooled over eight runs."""
    truth = NoiseModel(white=1e-6, coloured=4e-6, correlation=0.8)
    runs = [swing(0.0, 0.1, seed, truth) for seed in range(8)]
    assert measured_noise(runs).standard_deviation == pytest.approx(truth.standard_deviation, rel=0.3)


def test_before_the_first_voltage_a_body_is_at_rest():
    """What the drive does later is not looked at."""
    found = measured_noise([driven(0.3, seed) for seed in range(3)])
    assert found.standard_deviation == pytest.approx(FAINT.standard_deviation, rel=0.3)


def test_a_recording_that_begins_in_full_swing_has_no_rest():
    """Nor has one whose drive is on from the first frame."""
    assert measured_noise([swing(released=-2.0, initial_time=0.13)]) is None
    assert measured_noise([driven(-0.5, 0)]) is None


def test_what_differs_between_equal_runs_is_noise():
    """It comes before the noise at rest: a run may vary more than a camera does."""
    found = measured_noise([driven(0.3, 1), driven(0.3, 2, amplitude=0.101)])
    assert "repeated runs" in found.source
    assert found.standard_deviation > 5 * FAINT.standard_deviation


def test_noise_may_be_given():
    """As its standard deviation, above 0."""
    assert given_noise(0.003).standard_deviation == pytest.approx(0.003)
    with pytest.raises(SysidError, match="expected a standard deviation"):
        given_noise(0.0)
