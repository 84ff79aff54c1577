"""Places where forces act."""

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.mesh.sites import body_sites, flux_sites, line_sites, point_sites, skin_sites


def test_skin_sites_add_up_to_the_circumference(rectangle):
    """Measures sum to 2 (length + height); a clamped body has no skin where it is clamped."""
    for clamped, expected in ((False, 0.21), (True, 0.205)):
        mesh = Builder(rectangle(0.1, 0.005, clamped)).mesh
        assert skin_sites(mesh).measure.sum() == pytest.approx(expected)


def test_tangents_of_the_skin_have_unit_length_at_rest(swimmer):
    """The derivative of the position along the undeformed skin."""
    mesh = Builder(swimmer).mesh
    tangent = skin_sites(mesh).tangent(mesh.nodes[..., None])[..., 0]
    assert np.linalg.norm(tangent, axis=1) == pytest.approx(np.ones(len(tangent)))


def test_a_uniform_pressure_on_the_closed_skin_has_no_resultant(swimmer):
    """Forces along the normals, scattered to the nodes, sum to zero."""
    mesh = Builder(swimmer).mesh
    sites = skin_sites(mesh)
    tangent = sites.tangent(mesh.nodes[..., None])
    out = np.zeros((*mesh.nodes.shape, 1))
    sites.scatter(np.stack([tangent[:, 1], -tangent[:, 0]], axis=1), out)
    assert np.abs(out.sum(axis=0)).max() < 1e-6 * np.abs(out).sum()


def test_body_sites_stand_for_the_whole_mass(rectangle):
    """Measures are positive and sum to density times area."""
    mesh = Builder(rectangle(0.1, 0.005)).mesh
    measure = body_sites(mesh, mesh.nodes, np.full(len(mesh.elements), 1000.0)).measure
    assert measure.min() > 0
    assert measure.sum() == pytest.approx(1000 * 0.1 * 0.005)


def test_a_force_on_a_point_keeps_its_sum_and_moment(swimmer):
    """Scattered to the nodes around it."""
    mesh = Builder(swimmer).mesh
    out = np.zeros((*mesh.nodes.shape, 1))
    point_sites(mesh, np.array([[0.1, 0.0]])).scatter(np.array([[[0.0], [2.0]]]), out)
    out = out[..., 0]
    assert out.sum(axis=0) == pytest.approx([0.0, 2.0], abs=1e-12)
    assert (mesh.nodes[:, 0] * out[:, 1]).sum() == pytest.approx(0.2)


def test_sites_of_the_centre_line_run_from_nose_to_tail(swimmer):
    """Measures sum to the whole length; the tangent is the direction of the body; the last site is the tail's end."""
    mesh = Builder(swimmer).mesh
    line = line_sites(mesh)
    assert line.measure.sum() == pytest.approx(0.19)
    assert line.value(mesh.nodes[..., None])[-1, :, 0] == pytest.approx([0.19, 0.0])
    tangent = line.tangent(mesh.nodes[..., None])[..., 0]
    assert tangent == pytest.approx(np.tile([1.0, 0.0], (len(tangent), 1)), abs=1e-9)


def test_a_flux_along_the_centre_line_sums_to_its_value_at_the_tail(swimmer):
    """Whatever the flux: what one piece gives the next one takes."""
    mesh = Builder(swimmer).mesh
    flux = np.random.default_rng(1).standard_normal((len(line_sites(mesh).nodes), 2, 1))
    out = np.zeros((*mesh.nodes.shape, 1))
    flux_sites(line_sites(mesh)).scatter(flux, out)
    assert out.sum(axis=0)[:, 0] == pytest.approx(flux[-1, :, 0])
