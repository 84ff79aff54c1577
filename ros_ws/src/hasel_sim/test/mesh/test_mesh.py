# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The eight-node element.

Meshes of planar strips: outline, spine and fin, muscles, regions, grading.
"""

import numpy as np
import pytest
from hasel_sim.errors import ModelError
from hasel_sim.mesh.body_mesh import Stretch, StripShape, half_height, strip_mesh
from hasel_sim.mesh.mesh import (
    Region,
    edge_functions,
    reference_gradients,
    shape_functions,
    square_quadrature,
)
from hasel_sim.model_mesh import body_mesh, marker_points, model_mesh

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


def _areas(mesh) -> np.ndarray:
    return reference_gradients(mesh.nodes[mesh.elements], 3)[2].sum(axis=1)


def test_the_swimmer_has_the_area_of_its_outline_and_fin(swimmer):
    """Twice the integral of the half height, plus the fin."""
    mesh, body = model_mesh(swimmer), swimmer.description.body
    polynomial = np.polynomial.Polynomial(body.coefficients).integ()
    area = 2 * body.largest_half_height_m * body.length_m * (polynomial(1.0) - polynomial(0.0))
    fin = body.spine.fin_length_m * body.spine_thickness_m
    assert _areas(mesh).sum() == pytest.approx(area + fin, rel=1e-3)


@pytest.mark.parametrize("density", [0.5, 1.0, 2.0])
def test_the_mesh_follows_the_spine_and_the_regions(density, swimmer):
    """Every element lies in its region: spine within its faces, muscles between head and stalk on their side."""
    mesh, body = model_mesh(swimmer.with_numerics(mesh_density=density)), swimmer.description.body
    place = swimmer.description.muscles[0]
    low, high = (getattr(mesh.nodes[mesh.elements], bound)(axis=1) for bound in ("min", "max"))
    spine, upper = mesh.region == Region.SPINE, mesh.region == Region.UPPER_MUSCLE
    lower, half = mesh.region == Region.LOWER_MUSCLE, 0.5 * body.spine_thickness_m
    assert np.abs([low[spine, 1].min(), high[spine, 1].max()]) == pytest.approx(half)
    assert low[upper, 1].min() == pytest.approx(half)
    assert high[lower, 1].max() == pytest.approx(-half)
    for muscle in (upper, lower):
        assert low[muscle, 0].min() == pytest.approx(place.from_m)
        assert high[muscle, 0].max() == pytest.approx(place.to_m)
    assert high[spine, 0].max() == pytest.approx(body.whole_length_m)


def test_the_default_is_graded_into_the_root_of_the_fin(swimmer):
    """275 nodes; the columns beside the root are a sixteenth of the spine apart, and grow away from it."""
    mesh, length = model_mesh(swimmer), swimmer.description.body.length_m
    assert len(mesh.nodes) == 275
    ends = np.unique(np.round(mesh.nodes[mesh.elements[:, :4], 0], 9))
    steps, root = np.diff(ends), int(np.searchsorted(ends, length - 1e-6))
    assert steps[[root - 1, root]] == pytest.approx(1e-3 / 16, rel=1e-3)
    assert np.all(np.diff(steps[root:]) > 0)
    assert np.all(np.diff(steps[root - 6 : root]) < 0)


def test_the_density_scales_lengths_and_layers_are_asked_for_apart(swimmer):
    """Twice the density is twice the elements; twice the layers cut the soft halves only."""
    one, fine, thick = (
        model_mesh(swimmer.with_numerics(**k)) for k in ({}, {"mesh_density": 2.0}, {"layers": 2})
    )
    assert len(fine.elements) == pytest.approx(2 * len(one.elements), rel=0.02)
    assert (thick.region == Region.SPINE).sum() == (one.region == Region.SPINE).sum()
    assert (thick.region != Region.SPINE).sum() == 2 * (one.region != Region.SPINE).sum()


def test_muscles_and_regions_lie_where_they_are_said_to():
    """Three muscles of one side and a stiff head: elements end at every border and carry their numbers."""
    muscles = tuple(Stretch(a, a + 0.02, ("lower",)) for a in (0.01, 0.04, 0.07))
    shape = StripShape(
        0.1, 0.01, (1.0,), clamped=True, muscles=muscles, regions=(Stretch(0.0, 0.013, ("upper", "lower")),)
    )
    mesh = strip_mesh(shape, 1.0, 1)
    corners = mesh.nodes[mesh.elements[:, :4]]
    for number, muscle in enumerate(muscles, start=1):
        own = corners[mesh.muscle == number]
        assert own[..., 0].min() == pytest.approx(muscle.start)
        assert own[..., 0].max() == pytest.approx(muscle.end)
        assert own[..., 1].max() == pytest.approx(0.0)
    stiff = corners[mesh.material == 1]
    assert stiff[..., 0].max() == pytest.approx(0.013)
    assert np.ptp(stiff[..., 1]) == pytest.approx(0.02)
    assert mesh.nodes[mesh.tip, 0] == pytest.approx(0.1)


def test_the_numbering_is_narrow_banded(swimmer):
    """The half bandwidth is that of two columns, not of the body, and narrower still along the fin."""
    reach = model_mesh(swimmer).reach
    assert reach.max() < 30
    assert reach[-120:].max() < 16


def test_the_skin_runs_around_the_body_with_the_body_to_its_left(swimmer):
    """The area enclosed by the skin's edges is the mesh's (Green's theorem)."""
    mesh = model_mesh(swimmer)
    edges = np.concatenate([mesh.skin[:, :2], mesh.skin[:, 1:]])
    start, end = mesh.nodes[edges[:, 0]], mesh.nodes[edges[:, 1]]
    enclosed = 0.5 * (start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0]).sum()
    assert enclosed == pytest.approx(_areas(mesh).sum(), rel=5e-3)
    assert sorted(mesh.skin[:, 0]) == sorted(mesh.skin[:, 2])


def test_a_changed_outline_moves_the_nodes_where_a_new_mesh_has_them(swimmer):
    """Coefficient by coefficient, and the largest half height."""
    described = swimmer.description.body
    for index, coefficient in enumerate(described.coefficients):
        changed = list(described.coefficients)
        changed[index] = coefficient + 1e-3
        fresh = body_mesh(
            swimmer.description.model_copy(update={"body": described.with_outline(tuple(changed))})
        )
        name = f"body.outline.coefficients.{index}"
        moved = model_mesh(swimmer.with_freed(name).with_values({name: changed[index]}))
        assert moved.nodes == pytest.approx(fresh.nodes, abs=1e-12)
    name = "body.outline.largest_half_height_m"
    taller = model_mesh(swimmer.with_freed(name).with_values({name: 0.0076})).nodes
    assert taller[:, 1].max() / model_mesh(swimmer).nodes[:, 1].max() == pytest.approx(0.0076 / 0.0075)
    assert taller[:, 0] == pytest.approx(model_mesh(swimmer).nodes[:, 0])


def test_spine_and_fin_move_the_nodes_and_what_lies_on_them(swimmer):
    """The area of a new mesh; the tail marker stays at the fin's tip, and the file that is written holds together."""
    values = {"body.spine.thickness_m": 0.0015, "body.spine.fin_length_m": 0.042}
    moved = swimmer.with_freed(*values).with_values(values)
    fresh = swimmer.description.body.spine.model_copy(
        update={"thickness_m": 0.0015, "fin_length_m": 0.042},
    )
    body = swimmer.description.body.model_copy(update={"spine": fresh})
    expected = body_mesh(swimmer.description.model_copy(update={"body": body}))
    assert _areas(model_mesh(moved)).sum() == pytest.approx(_areas(expected).sum(), rel=1e-5)
    spine = model_mesh(moved).region == Region.SPINE
    assert _areas(model_mesh(moved))[spine].sum() == pytest.approx(0.0015 * 0.202)
    assert marker_points(moved)[2] == pytest.approx([0.202, 0.0])
    assert marker_points(moved)[:2] == pytest.approx(marker_points(swimmer)[:2])
    for value in (0.0, -0.01):
        with pytest.raises(ModelError, match=r"body.spine.fin_length_m is .*; expected more than 0"):
            model_mesh(moved.with_values({"body.spine.fin_length_m": value}))
    with pytest.raises(ModelError, match="crosses the spine"):
        model_mesh(moved.with_values({"body.spine.thickness_m": 0.005}))


def test_the_outline_has_the_given_largest_height(swimmer):
    """The default's maximum is 7.5 mm at s = 0.35."""
    body = swimmer.description.body
    s = np.linspace(0, 1, 2001)
    height = half_height(np.array(body.coefficients), body.largest_half_height_m, s)
    assert height.max() == pytest.approx(7.5e-3, rel=1e-3)
    assert s[height.argmax()] == pytest.approx(0.35, abs=0.01)


def test_an_outline_that_crosses_the_spine_is_refused(swimmer):
    """The sentence says where and what to change."""
    body = swimmer.description.body.with_outline((0.3, -0.5))
    with pytest.raises(ModelError, match=r"crosses the spine.*change the outline's coefficients"):
        body_mesh(swimmer.description.model_copy(update={"body": body}))


def test_a_clamped_rectangle_holds_its_first_nodes(rectangle):
    """Those at x = 0, numbered first; a free one holds none."""
    clamped, free = model_mesh(rectangle()), model_mesh(rectangle(clamped=False))
    assert np.all(clamped.nodes[clamped.clamped, 0] == 0.0)
    assert clamped.clamped.tolist() == list(range((clamped.nodes[:, 0] == 0.0).sum()))
    assert len(free.clamped) == 0


def test_a_material_point_is_found_with_its_gradient(swimmer):
    """Interpolating the node positions gives the point back, and the gradient of x and y the identity."""
    mesh = model_mesh(swimmer)
    nodes, shape, gradient = mesh.point((0.094, 0.0))
    assert shape @ mesh.nodes[nodes] == pytest.approx([0.094, 0.0], abs=1e-12)
    assert mesh.nodes[nodes].T @ gradient == pytest.approx(np.eye(2))
    with pytest.raises(ValueError, match="outside the body"):
        mesh.point((0.3, 0.0))
