"""Band storage, factors and solves against dense linear algebra."""

import numpy as np
import pytest
from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.banded import BandMatrix


def _random_band(held: int):
    k, n = 5, 22
    reach = np.minimum(np.where(np.arange(n) < 8, k, k - 1), np.arange(n)[::-1])
    band, dense = BandMatrix(reach, held), np.zeros((n, n))
    random = np.random.default_rng(1)
    for i in range(n):
        for j in range(n):
            if j > i + reach[i] or i > j + reach[j]:
                continue
            dense[i, j] = random.normal() + 5 * (i == j)
            band.entries[i, band.diagonal + j - i] = dense[i, j]
    return band, dense


@pytest.mark.parametrize("transposed", [False, True])
@pytest.mark.parametrize("held", [0, 2])
def test_factors_solve_what_dense_algebra_solves(transposed, held):
    """Several right-hand sides, plain and transposed, with held unknowns left out."""
    band, dense = _random_band(held)
    right = np.random.default_rng(2).normal(size=(4, 11, 2))
    found = band.factorise().solve(right, transposed).reshape(4, 22)
    inner = dense[held:, held:]
    expected = np.linalg.solve(inner.T if transposed else inner, right.reshape(4, 22)[:, held:].T).T
    assert found[:, held:] == pytest.approx(expected)
    assert not found[:, :held].any()


def test_solving_leaves_the_right_hand_side_alone():
    """A caller may use it again."""
    band, _ = _random_band(0)
    right = np.ones((2, 11, 2))
    band.factorise().solve(right)
    assert np.all(right == 1.0)


def test_a_singular_matrix_is_reported():
    """A free body in statics has none; the sentence says what to do."""
    with pytest.raises(SimulationError, match="singular"):
        BandMatrix(np.full(8, 2)).factorise()
