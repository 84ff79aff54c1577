"""What residuals see of the parameters."""

import numpy as np
from hasel_sysid.estimation.directions import seen_directions

COLUMNS = np.random.default_rng(0).normal(size=(50, 3))


def test_estimate_is_least_squares():
    """It agrees with numpy's solver, whatever the units of the parameters."""
    jacobian, change = COLUMNS * [1e-9, 1.0, 1e6], np.random.default_rng(1).normal(size=50)
    expected = np.linalg.lstsq(COLUMNS, change, rcond=None)[0] / [1e-9, 1.0, 1e6]
    np.testing.assert_allclose(seen_directions(jacobian).estimate(change), expected, rtol=1e-9)


def test_what_nothing_shows_is_undetermined_and_does_not_move():
    """A parameter without any response stays where it is and is marked."""
    seen = seen_directions(np.column_stack([COLUMNS, np.zeros(50)]))
    assert seen.undetermined.tolist() == [False, False, False, True]
    assert seen.estimate(np.ones(50))[3] == 0.0


def test_no_parameters():
    """A model without free parameters has no direction."""
    seen = seen_directions(np.zeros((50, 0)))
    assert seen.left.shape == (50, 0) and seen.estimate(np.ones(50)).shape == (0,)
