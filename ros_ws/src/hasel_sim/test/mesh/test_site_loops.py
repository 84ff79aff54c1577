"""Compiled loops between nodes and sites, against sums written with numpy."""

import numpy as np
import pytest
from hasel_sim.mesh.site_loops import interpolate, spread, subtract_products
from hasel_sim.mesh.sites import Sites
from hasel_sim.simd import LANES, lane_tuple
from numba.core.errors import TypingError

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
