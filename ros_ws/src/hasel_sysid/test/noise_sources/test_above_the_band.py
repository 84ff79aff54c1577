"""An upper bound of the noise where a model is badly wrong."""

import numpy as np
import pytest
from hasel_sysid.noise.model import NoiseModel
from hasel_sysid.noise_sources.above_the_band import noise_above_the_band
from hasel_sysid.testing.made_up_runs import made_up_evaluation

TIME = np.arange(0, 4.0, 1 / 120)


def evaluation(missed, truth, seed):
    """Four runs of a body that swings at 2 Hz; the model misses `missed`."""
    runs = np.repeat(np.arange(4), len(TIME))
    noise = truth.sample(runs, 1, np.random.default_rng(seed))[:, 0]
    return made_up_evaluation(noise.reshape(4, -1) + missed, TIME, simulated=0.2 * np.sin(4 * np.pi * TIME))


@pytest.mark.parametrize("missed", [0.0, 0.15])
def test_a_swing_at_another_frequency_is_not_noise(missed):
    """White noise of 0.003 is seen as it is, beside an error of fifty times that."""
    truth = NoiseModel(white=9e-6, coloured=0.0, correlation=0.5)
    wrong = missed * np.exp(-TIME) * np.sin(6 * np.pi * TIME)
    found = [noise_above_the_band(evaluation(wrong, truth, seed)).standard_deviation for seed in range(5)]
    assert np.mean(found) == pytest.approx(0.003, rel=0.2)


def test_slow_noise_is_bounded_from_above():
    """Its fast end alone does not tell its memory, so the bound is loud, but not by more than half."""
    truth = NoiseModel(white=0.0, coloured=9e-6, correlation=0.9)
    found = [noise_above_the_band(evaluation(0 * TIME, truth, seed)) for seed in range(5)]
    assert 0.003 < np.mean([noise.standard_deviation for noise in found]) < 0.0055
    assert all(noise.upper_bound for noise in found)
