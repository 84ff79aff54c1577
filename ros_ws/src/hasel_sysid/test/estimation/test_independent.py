"""How many frames of an error count."""

import numpy as np
import pytest
from hasel_sysid.estimation.independent import independent_share
from scipy.signal import lfilter


@pytest.mark.parametrize("memory", [0.0, 0.5, 0.9])
def test_the_variance_of_squares_is_that_of_so_many_independent_ones(memory):
    """Of autoregressive series, whose sums of squares are drawn many times."""
    drawn = np.random.default_rng(1).standard_normal((1200, 2000))
    series = lfilter([1.0], [1.0, -memory], drawn, axis=1)[:, 1000:]
    squares = (series**2).sum(axis=1)
    share = np.mean([independent_share(one, np.zeros(1000)) for one in series])
    assert share == pytest.approx(2 * squares.mean() ** 2 / squares.var() / 1000, rel=0.15)


def test_neighbours_in_different_runs_share_nothing():
    """Runs of one frame are independent, whatever they hold."""
    assert independent_share(np.ones(50), np.arange(50)) == 1.0
    assert independent_share(np.ones(50), np.zeros(50)) < 0.05


def test_no_error_at_all_leaves_every_frame():
    """Nothing is shared."""
    assert independent_share(np.zeros(50), np.zeros(50)) == 1.0
