"""From marker positions to the angle."""

import numpy as np
import pytest
from hasel_sim.build import Builder, marker_points
from hasel_sim.observation import MarkerRows, sin_theta


@pytest.mark.parametrize("degrees", [-120.0, -30.0, 0.0, 45.0])
def test_sin_theta_is_that_of_the_angle_between_the_two_chords(degrees):
    """Positive towards the upper side, whatever the body's heading and size."""
    angle = np.radians(degrees)
    markers = np.array([[0.0, 0.0], [2.0, 0.0], [2.0 + 3 * np.cos(angle), 3 * np.sin(angle)]])
    heading = np.radians(33.0)
    turn = np.array([[np.cos(heading), np.sin(heading)], [-np.sin(heading), np.cos(heading)]])
    assert sin_theta(0.1 * markers @ turn + [5.0, 7.0]) == pytest.approx(np.sin(angle))


def test_markers_move_with_the_body_and_fixed_ones_do_not(swimmer):
    """A rigid turn of all nodes turns the markers and the lines across the body."""
    mesh, points = Builder(swimmer).mesh, marker_points(swimmer)
    rows = MarkerRows(mesh, points, np.array([False, True, False]))
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    where, across = rows(mesh.nodes @ turn.T)
    assert where[[0, 2]] == pytest.approx(points[[0, 2]] @ turn.T, abs=1e-12)
    assert across[[0, 2]] == pytest.approx(np.array([[-1.0, 0.0], [-1.0, 0.0]]), abs=1e-9)
    assert (where[1], across[1]) == (pytest.approx(points[1]), pytest.approx([0.0, 1.0]))
