# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Upper bounds of the noise where a model is badly wrong."""

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sysid.noise import NoiseModel
from hasel_sysid.noise_bounds import bounded_noise, noise_above_the_band, noise_between_periods
from hasel_sysid.testing.made_up_runs import made_up_evaluation

TIME = np.arange(0, 4.0, 1 / 120)
SWING = 0.2 * np.sin(4 * np.pi * TIME)
TRUTH = NoiseModel(white=4e-6, coloured=5e-6, correlation=0.9)
WHITE = NoiseModel(white=9e-6, coloured=0.0, correlation=0.5)
SEEDS = range(5)


def box(frequency: float) -> DriveSchedule:
    """The two muscles in turn."""
    time = np.arange(0, 4.0, 0.5 / frequency)
    upper = np.arange(len(time)) % 2 == 0
    return DriveSchedule(time, 5000.0 * np.stack([upper, ~upper], axis=1))


def evaluation(missed, seed, noise=TRUTH, schedules=(None,) * 4):
    """Runs of a body that swings at 2 Hz; the model misses `missed` at every time."""
    runs = np.repeat(np.arange(len(schedules)), len(TIME))
    residual = noise.sample(runs, 1, np.random.default_rng(seed))[:, 0].reshape(len(schedules), -1)
    jacobian = np.sin(TIME)[:, None]
    return made_up_evaluation(residual + missed, TIME, schedules, SWING, jacobian, ("size",))


@pytest.mark.parametrize("missed", [0.0, 0.15])
def test_a_swing_at_another_frequency_is_not_noise(missed):
    """The periodogram above the body's band shows white noise as it is, beside an error of fifty times that."""
    wrong = missed * np.exp(-TIME) * np.sin(6 * np.pi * TIME)
    found = [noise_above_the_band(evaluation(wrong, seed, WHITE)).standard_deviation for seed in SEEDS]
    assert np.mean(found) == pytest.approx(0.003, rel=0.2)


def test_slow_noise_is_bounded_from_above():
    """Its fast end alone does not tell its memory, so the bound is loud, but not by more than half."""
    truth = NoiseModel(white=0.0, coloured=9e-6, correlation=0.9)
    found = [noise_above_the_band(evaluation(0.0, seed, truth)) for seed in SEEDS]
    assert 0.003 < np.mean([noise.standard_deviation for noise in found]) < 0.0055
    assert all(noise.upper_bound for noise in found)


@pytest.mark.parametrize("missed", [0.0, 0.02])
def test_what_repeats_itself_is_not_noise(missed):
    """An error six times the noise, sharp and alike in every period of the drive, makes the noise no louder."""
    half, since = np.divmod(np.arange(len(TIME)), 30)
    error = missed * (-1.0) ** half * np.exp(-since / 6)
    found = [noise_between_periods(evaluation(error, seed, schedules=[box(2.0)] * 6)) for seed in SEEDS]
    mean = np.mean([noise.standard_deviation for noise in found])
    assert mean == pytest.approx(TRUTH.standard_deviation, rel=0.1)


def test_without_a_drive_that_repeats_there_is_no_answer():
    """Passive bodies, and runs of one period, cannot tell."""
    assert noise_between_periods(evaluation(0.0, 0, schedules=[None, None])) is None
    assert noise_between_periods(evaluation(0.0, 0, schedules=[box(0.25)])) is None


def test_the_bound_is_the_least_that_any_look_allows():
    """Of several fits, one of them with a periodic error, no look at the bad one makes the noise loud."""
    error = 0.02 * np.sin(8 * np.pi * TIME)
    for seed in SEEDS:
        fits = [evaluation(missed, seed, WHITE, [box(2.0)] * 4) for missed in (error, 0.1 * error)]
        found = bounded_noise(fits)
        assert found.upper_bound
        assert found.standard_deviation == pytest.approx(0.003, rel=0.25)
