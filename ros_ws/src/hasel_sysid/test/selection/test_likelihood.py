"""The likelihood of correlated residuals, against the covariance written out."""

import numpy as np
import pytest
from hasel_sysid.noise.model import LONGEST_CORRELATION, NoiseModel
from hasel_sysid.selection.likelihood import Likelihood
from scipy.linalg import toeplitz
from scipy.stats import multivariate_normal

RUNS = np.repeat([0, 1], [40, 25])
NOISE = NoiseModel(0.5, 2.0, 0.8)
DISCREPANCY = 0.7


def covariance(count, slack=None):
    """Of the frames of one run."""
    lag = np.arange(count)
    first = NOISE.coloured * NOISE.correlation**lag + DISCREPANCY**2 * LONGEST_CORRELATION**lag
    first[0] += NOISE.white
    return toeplitz(first) + (0.0 if slack is None else slack @ slack.T)


@pytest.fixture
def generator():
    """Seeded."""
    return np.random.default_rng(5)


@pytest.mark.parametrize("finer", [0, 2])
def test_differences_of_the_logarithm_are_those_of_the_density(generator, finer):
    """Of two series without their run's mean, where an offset of any size is as likely as any other."""
    slack = generator.standard_normal((len(RUNS), finer))
    likelihood = Likelihood(NOISE, RUNS, DISCREPANCY, slack)
    series = generator.standard_normal((len(RUNS), 2))
    ours = -0.5 * (likelihood.whiten(series) ** 2).sum(axis=0)
    theirs = np.zeros(2)
    for run in (0, 1):
        here = run == RUNS
        # a proper prior so wide that it is none
        full = covariance(here.sum(), slack[here]) + 1e6
        theirs += [multivariate_normal(cov=full).logpdf(series[here, n]) for n in (0, 1)]
    assert ours[0] - ours[1] == pytest.approx(theirs[0] - theirs[1], rel=1e-4)


def test_an_offset_of_a_run_changes_nothing(generator):
    """It is a nuisance."""
    likelihood = Likelihood(NOISE, RUNS, DISCREPANCY)
    series = generator.standard_normal(len(RUNS))
    moved = series + np.where(RUNS == 1, 3.0, -1.0)
    assert likelihood.whiten(moved) == pytest.approx(likelihood.whiten(series), abs=1e-9)


def test_noise_becomes_independent_and_of_variance_one(generator):
    """All of it but the offset of either run."""
    likelihood = Likelihood(NOISE, RUNS)
    draws = likelihood.whiten(NOISE.sample(RUNS, 4000, generator))
    spread = np.cov(draws)
    assert np.trace(spread) == pytest.approx(len(RUNS) - 2, rel=0.02)
    assert np.abs(spread - np.diag(np.diag(spread))).max() < 0.12
