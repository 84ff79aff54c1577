"""Noise from what differs between periods of the drive."""

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sysid.noise.model import NoiseModel
from hasel_sysid.noise_sources.between_periods import noise_between_periods
from hasel_sysid.testing.made_up_runs import made_up_evaluation

TIME = np.arange(0, 4.0, 1 / 120)
TRUTH = NoiseModel(white=4e-6, coloured=5e-6, correlation=0.9)


def box(frequency: float) -> DriveSchedule:
    """The two muscles in turn."""
    time = np.arange(0, 4.0, 0.5 / frequency)
    upper = np.arange(len(time)) % 2 == 0
    return DriveSchedule(time, 5000.0 * np.stack([upper, ~upper], axis=1))


def evaluation(missed, schedules, seed=0):
    """Runs with noise and what a model misses at every time."""
    runs = np.repeat(np.arange(len(schedules)), len(TIME))
    noise = TRUTH.sample(runs, 1, np.random.default_rng(seed))[:, 0]
    residual = noise.reshape(len(schedules), -1) + missed
    return made_up_evaluation(residual, TIME, schedules, jacobian=np.sin(TIME)[:, None], names=("size",))


@pytest.mark.parametrize("missed", [0.0, 0.02])
def test_what_repeats_itself_is_not_noise(missed):
    """An error six times the noise, sharp and alike in every period, does not make the noise louder."""
    half, since = np.divmod(np.arange(len(TIME)), 30)
    error = missed * (-1.0) ** half * np.exp(-since / 6)
    found = [noise_between_periods(evaluation(error, [box(2.0)] * 6, seed)) for seed in range(5)]
    mean = np.mean([noise.standard_deviation for noise in found])
    assert mean == pytest.approx(TRUTH.standard_deviation, rel=0.1)


def test_without_a_drive_that_repeats_there_is_no_answer():
    """Passive bodies, and runs of one period, cannot tell."""
    assert noise_between_periods(evaluation(0.0, [None, None])) is None
    assert noise_between_periods(evaluation(0.0, [box(0.25)])) is None
