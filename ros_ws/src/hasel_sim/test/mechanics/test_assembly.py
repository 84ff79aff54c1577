# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What force effects add to the matrix of a step."""

import numpy as np
import pytest
from hasel_sim.mechanics.assembly import add_site_matrix, site_groups
from hasel_sim.mesh.sites import Sites
from hasel_sim.simd import lane_tuple


@pytest.mark.parametrize("lanes", [1, 4])
def test_groups_add_what_their_sites_add_one_by_one(lanes):
    """Three sites of one element, two of another, a point; two laws, of which one looks at the tangent."""
    draw = np.random.default_rng(3).standard_normal
    nodes = np.array([[0, 2, 3]] * 3 + [[1, 4, 5]] * 2 + [[0, 1, 2]])
    sites = Sites(nodes, draw((6, 3)), draw((6, 3)), draw(6), draw((6, 3)))
    by_value, by_tangent = draw((2, 12, 2, 2, lanes))
    one_by_one, grouped = np.zeros((2, 12, 23, lanes))
    for matrices, interpolation in (
        (by_value[:6], sites.shape),
        (by_tangent[:6], sites.slope),
        (by_value[6:], sites.shape),
    ):
        for s, a, b, i, j in np.ndindex(6, 3, 3, 2, 2):
            row, column = 2 * nodes[s, a] + i, 2 * nodes[s, b] + j
            product = sites.weight[s, a] * interpolation[s, b]
            one_by_one[row, 11 + column - row] += product * matrices[s, i, j]
    groups = site_groups([(sites, True), (sites, False)])
    add_site_matrix((groups, by_value, by_tangent), grouped, 11, lane_tuple(lanes))
    assert grouped == pytest.approx(one_by_one, abs=1e-13)
    assert np.abs(grouped).max() > 1.0
