"""What force effects add to the matrix of a step, in a compiled loop.

Sites that follow each other at the same nodes, as those of one element do, make a group: their matrices are summed
before they go to the band. What a force at a site does to node a when the field at node b changes is a product that no
motion changes; the products of all groups stand in one list.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit

from hasel_sim.mesh.sites import Sites
from hasel_sim.simd import add, load, zero


class SiteGroups(NamedTuple):
    """first: sites that each group begins with, and their number; start: the same in the list of its nodes; nodes: of
    every group; value, tangent: where the group's products [nodes, nodes, sites] begin in `products`, by the value and
    by the tangent of the field, -1 where no force of it looks at the tangent; alike: whether those by the value are the
    same for nodes exchanged.
    """

    first: np.ndarray
    start: np.ndarray
    nodes: np.ndarray
    value: np.ndarray
    tangent: np.ndarray
    alike: np.ndarray
    products: np.ndarray


def site_groups(laws: Sequence[tuple[Sites, bool]]) -> SiteGroups:
    """Of the sites of all laws, one after the other; with each, whether it looks at the tangent."""
    first, start, nodes, value, tangent, alike = [0], [0], [np.zeros(0)], [], [], []
    products, count = [np.zeros(0)], 0

    def keep(shape: np.ndarray, weight: np.ndarray) -> int:
        nonlocal count
        products.append(np.einsum("sa,sb->abs", weight, shape).ravel())
        count += products[-1].size
        return count - products[-1].size

    for sites, looks_along in laws:
        changes = np.flatnonzero((sites.nodes[1:] != sites.nodes[:-1]).any(axis=1)) + 1
        same = np.array_equal(sites.weight, sites.shape * sites.measure[:, None])
        for group in np.split(np.arange(len(sites.nodes)), changes):
            weight = sites.weight[group]
            alike.append(same)
            nodes.append(sites.nodes[group[0]])
            first.append(first[-1] + len(group))
            start.append(start[-1] + sites.nodes.shape[1])
            value.append(keep(sites.shape[group], weight))
            tangent.append(keep(sites.slope[group], weight) if looks_along else -1)
    numbers = (first, start, np.concatenate(nodes), value, tangent, alike)
    return SiteGroups._make([*(np.array(n, dtype=np.intp) for n in numbers), np.concatenate(products)])


@njit(inline="always")
def _summed(products, place, matrices, first, count, lane):
    """The four components of the sum of site matrices, each times its product."""
    lanes = len(lane)
    xx, xy, yx, yy = zero(lane), zero(lane), zero(lane), zero(lane)
    for s in range(count):
        factor, at = products[place + s], 4 * (first + s) * lanes
        xx = xx + factor * load(matrices, at, lane)
        xy = xy + factor * load(matrices, at + lanes, lane)
        yx = yx + factor * load(matrices, at + 2 * lanes, lane)
        yy = yy + factor * load(matrices, at + 3 * lanes, lane)
    return xx, xy, yx, yy


@njit(inline="always")
def _add_block(band, at, below, block, lane):
    """Add two rows of two components, the second `below` the first."""
    lanes, (xx, xy, yx, yy) = len(lane), block
    add(band, at, xx)
    add(band, at + lanes, xy)
    add(band, at + below, yx)
    add(band, at + below + lanes, yy)


@njit(cache=True, fastmath=True, error_model="numpy")
def add_site_matrix(sites, band, diagonal, lane):
    """Add the site matrices [sites, 2, 2, lanes], by value and by tangent, to a band matrix; sites: `SiteGroups` and
    these two.
    """
    (first, start, nodes, value, tangent, alike, products), by_value, by_tangent = sites
    lanes, width = len(lane), band.shape[1]
    below = (width - 1) * lanes
    for g in range(len(value)):
        begin, count, size = first[g], first[g + 1] - first[g], start[g + 1] - start[g]
        for a in range(size):
            row = 2 * nodes[start[g] + a]
            for b in range(a if alike[g] else 0, size):
                column = 2 * nodes[start[g] + b]
                at = (row * (width - 1) + diagonal + column) * lanes
                block = _summed(products, value[g] + (a * size + b) * count, by_value, begin, count, lane)
                _add_block(band, at, below, block, lane)
                if alike[g] and a != b:
                    _add_block(band, (column * (width - 1) + diagonal + row) * lanes, below, block, lane)
            if tangent[g] >= 0:
                for b in range(size):
                    at = (row * (width - 1) + diagonal + 2 * nodes[start[g] + b]) * lanes
                    place = tangent[g] + (a * size + b) * count
                    _add_block(
                        band, at, below, _summed(products, place, by_tangent, begin, count, lane), lane
                    )
