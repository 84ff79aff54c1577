# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""From marker positions to the angle."""

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.model_mesh import MarkerRows, marker_points


def test_markers_move_with_the_body_and_fixed_ones_do_not(swimmer):
    """A rigid turn of all nodes turns the markers and the lines across the body."""
    mesh, points = Builder(swimmer).mesh, marker_points(swimmer)
    rows = MarkerRows(mesh, points, np.array([False, True, False]))
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    where, across = rows(mesh.nodes @ turn.T)
    assert where[[0, 2]] == pytest.approx(points[[0, 2]] @ turn.T, abs=1e-12)
    assert across[[0, 2]] == pytest.approx(np.array([[-1.0, 0.0], [-1.0, 0.0]]), abs=1e-9)
    assert (where[1], across[1]) == (pytest.approx(points[1]), pytest.approx([0.0, 1.0]))
