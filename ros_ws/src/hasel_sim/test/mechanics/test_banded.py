# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Band storage, factors and solves against dense linear algebra."""

import numpy as np
import pytest
from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.banded import BandMatrix

LANES = 4


def _random_band(held: int):
    """A band matrix of several lanes, and the same as dense matrices [lanes, n, n]."""
    k, n = 5, 22
    reach = np.minimum(np.where(np.arange(n) < 8, k, k - 1), np.arange(n)[::-1])
    band, dense = BandMatrix(reach, held, LANES), np.zeros((LANES, n, n))
    random = np.random.default_rng(1)
    for i in range(n):
        for j in range(n):
            if j > i + reach[i] or i > j + reach[j]:
                continue
            dense[:, i, j] = random.normal(size=LANES) + 5 * (i == j)
            band.entries[i, band.diagonal + j - i] = dense[:, i, j]
    return band, dense


@pytest.mark.parametrize("transposed", [False, True])
@pytest.mark.parametrize("held", [0, 2])
def test_factors_solve_what_dense_algebra_solves(transposed, held):
    """Several right-hand sides, plain and transposed, with held unknowns left out."""
    band, dense = _random_band(held)
    right = np.random.default_rng(2).normal(size=(3, 11, 2, LANES))
    found = band.factorise().solve(right, transposed).reshape(3, 22, LANES)
    for lane in range(LANES):
        inner = dense[lane, held:, held:]
        columns = right.reshape(3, 22, LANES)[:, held:, lane].T
        expected = np.linalg.solve(inner.T if transposed else inner, columns).T
        assert found[:, held:, lane] == pytest.approx(expected)
    assert not found[:, :held].any()


def test_solving_leaves_the_right_hand_side_alone():
    """A caller may use it again."""
    band, _ = _random_band(0)
    right = np.ones((2, 11, 2, LANES))
    band.factorise().solve(right)
    assert np.all(right == 1.0)


def test_a_singular_matrix_is_reported():
    """A free body in statics has none; the sentence says what to do."""
    with pytest.raises(SimulationError, match="singular"):
        BandMatrix(np.full(8, 2)).factorise()


def test_a_lane_with_a_singular_matrix_leaves_the_others_alone():
    """It is named, and the others are solved."""
    band, dense = _random_band(0)
    band.entries[:, :, 2] = 0.0
    factors = band.factorise()
    assert factors.singular.tolist() == [False, False, True, False]
    found = factors.solve(np.ones((1, 11, 2, LANES))).reshape(22, LANES)
    assert found[:, 3] == pytest.approx(np.linalg.solve(dense[3], np.ones(22)))
