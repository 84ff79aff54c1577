"""Least squares within bounds."""

import numpy as np
import pytest
from hasel_sysid.estimation.bounded import bounded_change
from scipy.optimize import lsq_linear

JACOBIAN = np.random.default_rng(0).standard_normal((50, 3)) * [1.0, 1e-4, 1e3]
TRUE = np.array([0.5, 200.0, -1e-3])


def test_without_bounds_it_is_least_squares():
    """Whatever the columns' scales."""
    far = np.full(3, np.inf)
    change, squares = bounded_change(JACOBIAN @ TRUE, JACOBIAN, -far, far)
    assert change == pytest.approx(TRUE, rel=1e-6) and squares == pytest.approx(0.0, abs=1e-12)


def test_bounds_hold():
    """And the others make up for it as well as they can."""
    lower, upper = np.array([-0.1, -np.inf, -np.inf]), np.array([0.1, np.inf, np.inf])
    change, squares = bounded_change(JACOBIAN @ TRUE, JACOBIAN, lower, upper)
    rest = np.linalg.lstsq(JACOBIAN[:, 1:], JACOBIAN @ TRUE - 0.1 * JACOBIAN[:, 0], rcond=None)
    assert change[0] == pytest.approx(0.1) and squares == pytest.approx(rest[1][0])


def test_what_nothing_shows_stays():
    """A column of zeros."""
    change, _ = bounded_change(
        np.ones(4), np.column_stack([np.ones(4), np.zeros(4)]), np.full(2, -9.0), np.full(2, 9.0)
    )
    assert change[1] == 0.0


@pytest.mark.parametrize("seed", range(20))
def test_many_bounds_are_met_as_an_interior_search_meets_them(seed):
    """Of eight columns that look alike, within bounds that most of them would leave; scipy's reflective search."""
    generator = np.random.default_rng(seed)
    columns = generator.standard_normal((60, 8)) + 3 * generator.standard_normal((60, 1))
    residual, reach = generator.standard_normal(60), 0.03 * generator.random(8)
    _, squares = bounded_change(residual, columns, -reach, reach)
    searched = lsq_linear(columns, residual, (-reach, reach), method="trf", tol=1e-12, max_iter=1000)
    assert squares <= 2 * searched.cost * (1 + 1e-9)
