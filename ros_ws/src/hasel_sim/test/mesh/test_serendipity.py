"""The eight-node element."""

import numpy as np
import pytest
from hasel_sim.mesh.serendipity import edge_functions, reference_gradients, shape_functions, square_quadrature

NODES = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0]], dtype=float)


def test_each_shape_function_is_one_at_its_node_and_zero_at_the_others():
    """Interpolation passes through the nodal values."""
    values = np.array([shape_functions(*node)[0] for node in NODES])
    assert values == pytest.approx(np.eye(8), abs=1e-15)


def test_quadratic_fields_are_exact():
    """Values and slopes of every polynomial up to x y^2 and x^2 y."""
    point = np.array([0.3, -0.7])
    value, slope = shape_functions(*point)
    for powers in ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (2, 1), (1, 2)):
        a, b = powers
        field = NODES[:, 0] ** a * NODES[:, 1] ** b
        expected = [
            a * point[0] ** max(a - 1, 0) * point[1] ** b,
            b * point[0] ** a * point[1] ** max(b - 1, 0),
        ]
        assert value @ field == pytest.approx(point[0] ** a * point[1] ** b)
        assert slope.T @ field == pytest.approx(np.array(expected))


@pytest.mark.parametrize("order", [2, 3])
def test_quadrature_is_exact_to_its_degree(order):
    """Monomials up to 2 n - 1 in each direction."""
    points, weights = square_quadrature(order)
    for power in range(2 * order):
        exact = 0.0 if power % 2 else 2 / (power + 1)
        assert (points[:, 0] ** power * weights).sum() == pytest.approx(2 * exact)
        assert (points[:, 0] ** power * points[:, 1] ** 2 * weights).sum() == pytest.approx(exact * 2 / 3)


def test_gradients_of_a_distorted_element_are_those_of_a_linear_field():
    """And its areas sum to the polygon's."""
    corners = np.array([[0.0, 0.0], [2.0, 0.3], [2.5, 1.5], [0.2, 1.0]])
    middles = 0.5 * (corners + np.roll(corners, -1, axis=0))
    nodes = np.concatenate([corners, middles])[None]
    _, gradients, areas = reference_gradients(nodes, 3)
    field = nodes[0] @ [3.0, -2.0]
    assert np.einsum("egac,a->egc", gradients, field) == pytest.approx(
        np.broadcast_to([3.0, -2.0], (1, 9, 2))
    )
    x, y = corners.T
    assert areas.sum() == pytest.approx(0.5 * abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)))


def test_edge_functions_interpolate_a_parabola():
    """Values and slopes between three nodes."""
    value, slope = edge_functions(0.4)
    parabola = np.array([-1.0, 0.0, 1.0]) ** 2
    assert (value @ parabola, slope @ parabola) == pytest.approx((0.16, 0.8))
