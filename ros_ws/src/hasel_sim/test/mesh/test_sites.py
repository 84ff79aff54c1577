# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Places where forces act.

Compiled loops between nodes and sites, against sums written with numpy.
"""

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.mesh.sites import (
    Sites,
    body_sites,
    flux_sites,
    interpolate,
    line_sites,
    point_sites,
    skin_sites,
    spread,
    subtract_products,
)
from hasel_sim.simd import LANES, lane_tuple
from numba.core.errors import TypingError


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


COLUMNS, NODES, SITES, AROUND = 3, 7, 11, 4


@pytest.fixture(params=LANES)
def world(request):
    """Nodes around every site, two kinds of weights, and a source of fields, for so many lanes."""
    generator = np.random.default_rng(1)
    nodes = generator.integers(0, NODES, (SITES, AROUND))
    shape, weights = generator.standard_normal((2, SITES, AROUND))
    return nodes, shape, weights, lambda *size: generator.standard_normal((*size, request.param))


def test_values_at_sites(world):
    """Weights times the values at the nodes around a site."""
    nodes, shape, _, field_of = world
    field, out = field_of(COLUMNS, NODES, 2), field_of(COLUMNS, SITES, 2)
    interpolate(field, nodes, shape, out, lane_tuple(field.shape[-1]))
    assert out == pytest.approx(np.einsum("sk,cskil->csil", shape, field[:, nodes]))


def test_forces_at_nodes(world):
    """Added to what is there; nodes that several sites share get the sum."""
    nodes, _, weights, field_of = world
    force, out = field_of(COLUMNS, SITES, 2), field_of(COLUMNS, NODES, 2)
    expected = out.copy()
    for column, one in enumerate(force):
        np.add.at(expected[column], nodes, weights[..., None, None] * one[:, None])
    spread(force, nodes, weights, out, lane_tuple(force.shape[-1]))
    assert out == pytest.approx(expected)


def test_products_are_subtracted(world):
    """The same as interpolating, multiplying and spreading one after the other."""
    nodes, shape, weights, field_of = world
    field, slope = field_of(COLUMNS, NODES, 2), field_of(SITES, 2, 2)
    out, lane = field_of(COLUMNS, NODES, 2), lane_tuple(field.shape[-1])
    expected, at_sites = out.copy(), np.einsum("sk,cskil->csil", shape, field[:, nodes])
    force = np.ascontiguousarray(-np.einsum("sijl,csjl->csil", slope, at_sites))
    spread(force, nodes, weights, expected, lane)
    subtract_products(field, slope, nodes, shape, weights, out, lane)
    assert out == pytest.approx(expected)


def test_an_array_that_cannot_be_written_in_place_is_refused(world):
    """Forces are never added to a copy."""
    nodes, shape, _, field_of = world
    sites = Sites.of(nodes, shape, np.zeros_like(shape), np.ones(SITES))
    turned = field_of(2, NODES).transpose(1, 0, 2)
    with pytest.raises(TypingError, match="contiguous"):
        sites.scatter(field_of(SITES, 2), turned)
