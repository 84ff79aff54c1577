"""Meshes of the swimmer and the rectangle."""

import numpy as np
import pytest
from hasel_sim.build import body_mesh, model_mesh
from hasel_sim.errors import ModelError
from hasel_sim.mesh.bodies import half_height
from hasel_sim.mesh.mesh import Region
from hasel_sim.mesh.serendipity import reference_gradients


def _areas(mesh) -> np.ndarray:
    return reference_gradients(mesh.nodes[mesh.elements], 3)[2].sum(axis=1)


def test_the_swimmer_has_the_area_of_its_outline_and_fin(swimmer):
    """Twice the integral of the half height, plus the fin."""
    mesh, body = model_mesh(swimmer), swimmer.description.body
    polynomial = np.polynomial.Polynomial(body.outline_coefficients).integ()
    area = 2 * body.largest_half_height_m * body.body_length_m * (polynomial(1.0) - polynomial(0.0))
    fin = body.fin_length_m * body.spine_thickness_m
    assert _areas(mesh).sum() == pytest.approx(area + fin, rel=1e-3)


@pytest.mark.parametrize("density", [0.5, 1.0, 2.0])
def test_the_mesh_follows_the_spine_and_the_regions(density, swimmer):
    """Every element lies in its region: spine within its faces, muscles between head and stalk on their side."""
    mesh, body = model_mesh(swimmer.with_numerics(mesh_density=density)), swimmer.description.body
    low, high = (getattr(mesh.nodes[mesh.elements], bound)(axis=1) for bound in ("min", "max"))
    spine, upper = mesh.region == Region.SPINE, mesh.region == Region.UPPER_MUSCLE
    lower, half = mesh.region == Region.LOWER_MUSCLE, 0.5 * body.spine_thickness_m
    assert np.abs([low[spine, 1].min(), high[spine, 1].max()]) == pytest.approx(half)
    assert low[upper, 1].min() == pytest.approx(half)
    assert high[lower, 1].max() == pytest.approx(-half)
    for muscle in (upper, lower):
        assert low[muscle, 0].min() == pytest.approx(body.head_length_m)
        assert high[muscle, 0].max() == pytest.approx(body.muscle_end_m)
    assert high[spine, 0].max() == pytest.approx(body.body_length_m + body.fin_length_m)


def test_one_number_refines_the_whole_mesh(swimmer):
    """Twice the density, about three times the nodes; the default has 336."""
    counts = [len(model_mesh(swimmer.with_numerics(mesh_density=d)).nodes) for d in (1.0, 2.0)]
    assert counts[0] == 336
    assert 2.5 < counts[1] / counts[0] < 3.5


def test_the_numbering_is_narrow_banded(swimmer):
    """The half bandwidth is that of two columns, not of the body, and narrower still along the fin."""
    reach = model_mesh(swimmer).reach
    assert reach.max() < 30
    assert reach[-200:].max() < 16


def test_the_skin_runs_around_the_body_with_the_body_to_its_left(swimmer):
    """The area enclosed by the skin's edges is the mesh's (Green's theorem)."""
    mesh = model_mesh(swimmer)
    start, end = mesh.nodes[mesh.skin[:, 0]], mesh.nodes[mesh.skin[:, 2]]
    enclosed = 0.5 * (start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0]).sum()
    assert enclosed == pytest.approx(_areas(mesh).sum(), rel=5e-3)
    assert sorted(mesh.skin[:, 0]) == sorted(mesh.skin[:, 2])


def test_the_outline_slope_is_how_nodes_move_with_a_coefficient(swimmer):
    """Against a mesh of a changed outline."""
    body = swimmer.description.body
    mesh = body_mesh(body, 1.0)
    for index in range(len(body.outline_coefficients)):
        changed = list(body.outline_coefficients)
        changed[index] += 1e-3
        moved = body_mesh(body.model_copy(update={"outline_coefficients": tuple(changed)}), 1.0)
        assert (moved.nodes - mesh.nodes) / 1e-3 == pytest.approx(mesh.outline_slope[index], abs=1e-12)


def test_the_outline_has_the_given_largest_height(swimmer):
    """The default's maximum is 7.5 mm at s = 0.35."""
    body = swimmer.description.body
    s = np.linspace(0, 1, 2001)
    height = half_height(np.array(body.outline_coefficients), body.largest_half_height_m, s)
    assert height.max() == pytest.approx(7.5e-3, rel=1e-3)
    assert s[height.argmax()] == pytest.approx(0.35, abs=0.01)


def test_an_outline_that_crosses_the_spine_is_refused(swimmer):
    """The sentence says where and what to change."""
    body = swimmer.description.body.model_copy(update={"outline_coefficients": (0.3, -0.5)})
    with pytest.raises(ModelError, match=r"crosses the spine.*change outline_coefficients"):
        body_mesh(body, 1.0)


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
