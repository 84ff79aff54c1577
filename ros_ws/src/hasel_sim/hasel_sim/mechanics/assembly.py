# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""From Gauss points, elements and sites to nodal forces and the band matrix, and along given directions.

Every array has the lanes as its last axis (see `simd.py`) but those that describe the mesh: elements, gradients and
areas. `stretch` is that of the stress-free shape along the body: gradients by x shrink with it, areas grow. Indices of
a stress run 00, 01, 10, 11 (row-major).

Sites that follow each other at the same nodes, as those of one element do, make a group: their matrices are summed
before they go to the band. What a force at a site does to node a when the field at node b changes is a product that no
motion changes; the products of all groups stand in one list.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit

from hasel_sim.mechanics.constitutive import COEFFICIENTS, FIBRE
from hasel_sim.mesh.sites import Sites
from hasel_sim.simd import Four, LaneTuple, Value, add, four, load, square_root, store, three, zero


@njit(inline="always")
def product(matrix: np.ndarray, at: int, vector: Four, lane: LaneTuple) -> Four:
    """The 4 x 4 numbers that start at a flat index, rows one after the other, times four numbers."""
    lanes = len(lane)
    x0, x1, x2, x3 = vector
    a0, a1, a2, a3 = four(matrix, at, lane)
    b0, b1, b2, b3 = four(matrix, at + 4 * lanes, lane)
    c0, c1, c2, c3 = four(matrix, at + 8 * lanes, lane)
    d0, d1, d2, d3 = four(matrix, at + 12 * lanes, lane)
    return (
        a0 * x0 + a1 * x1 + a2 * x2 + a3 * x3,
        b0 * x0 + b1 * x1 + b2 * x2 + b3 * x3,
        c0 * x0 + c1 * x1 + c2 * x2 + c3 * x3,
        d0 * x0 + d1 * x1 + d2 * x2 + d3 * x3,
    )


@njit(inline="always")
def add_stress(
    local: np.ndarray,
    P: Four,
    gradients: np.ndarray,
    e: int,
    g: int,
    area: float,
    wide: Value,
    lane: LaneTuple,
) -> None:
    """Add to local [8, 2, lanes] what the first Piola stress at a Gauss point (row by row) does to its element's nodes.

    gradients: [elements, points, 8, 2] of the shape functions; area: of the point; wide: times its stretch.
    """
    lanes = len(lane)
    p0, p1, p2, p3 = P
    p0, p1, p2, p3 = area * p0, wide * p1, area * p2, wide * p3
    for n in range(8):
        dx, dy = gradients[e, g, n, 0], gradients[e, g, n, 1]
        add(local, 2 * n * lanes, p0 * dx + p1 * dy)
        add(local, (2 * n + 1) * lanes, p2 * dx + p3 * dy)


@njit(inline="always")
def add_to_nodes(
    local: np.ndarray, elements: np.ndarray, e: int, first: int, out: np.ndarray, lane: LaneTuple
) -> None:
    """Add an element's forces [8, 2, lanes] to those of all nodes [columns, nodes, 2, lanes], from node `first` on."""
    lanes = len(lane)
    for n in range(8):
        at = 2 * lanes * (first + elements[e, n])
        add(out, at, load(local, 2 * n * lanes, lane))
        add(out, at + lanes, load(local, (2 * n + 1) * lanes, lane))


@njit(cache=True, fastmath=True, error_model="numpy")
def scatter_stress(
    P: np.ndarray,
    elements: np.ndarray,
    gradients: np.ndarray,
    areas: np.ndarray,
    stretch: np.ndarray,
    force: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Add the nodal forces of a stress field [elements, points, 4, lanes] to force [nodes, 2, lanes]."""
    lanes, points = len(lane), areas.shape[1]
    local = np.empty(16 * lanes)
    for e in range(elements.shape[0]):
        local[:] = 0.0
        for g in range(points):
            point = e * points + g
            area = areas[e, g]
            wide = area * load(stretch, point * lanes, lane)
            add_stress(local, four(P, 4 * lanes * point, lane), gradients, e, g, area, wide, lane)
        add_to_nodes(local, elements, e, 0, force, lane)


@njit(cache=True, fastmath=True, error_model="numpy")
def scatter_matrix(
    elastic: np.ndarray,
    viscous: np.ndarray,
    masses: np.ndarray,
    weights: np.ndarray,
    elements: np.ndarray,
    gradients: np.ndarray,
    areas: np.ndarray,
    stretch: np.ndarray,
    band: np.ndarray,
    diagonal: int,
    lane: LaneTuple,
) -> None:
    """Add weights[0] K + weights[1] C + weights[2] M to a band matrix, entry (i, j) at [i, diagonal + j - i].

    elastic, viscous: moduli [elements, points, 4, 4, lanes]; masses: [elements, 8, 8, lanes]; weights: [3, lanes].
    """
    lanes, points, width = len(lane), areas.shape[1], band.shape[1]
    half = np.empty(64 * points * lanes)
    by_position, by_velocity, by_acceleration = three(weights, 0, lane)
    none = zero(lane)
    for e in range(elements.shape[0]):
        for g in range(points):
            point = e * points + g
            along = load(stretch, point * lanes, lane)
            for row in range(4):
                at = (16 * point + 4 * row) * lanes
                k0, k1, k2, k3 = four(elastic, at, lane)
                v0, v1, v2, v3 = four(viscous, at, lane)
                s = areas[e, g] / along if row % 2 == 0 else areas[e, g] + none
                m0, m1 = by_position * k0 + by_velocity * v0, along * (by_position * k1 + by_velocity * v1)
                m2, m3 = by_position * k2 + by_velocity * v2, along * (by_position * k3 + by_velocity * v3)
                m0, m1, m2, m3 = s * m0, s * m1, s * m2, s * m3
                for b in range(8):
                    dx, dy = gradients[e, g, b, 0], gradients[e, g, b, 1]
                    at = (2 * b * points + g) * 4 * lanes + row * lanes
                    store(half, at, m0 * dx + m1 * dy)
                    store(half, at + 4 * points * lanes, m2 * dx + m3 * dy)
        for column in range(16):
            b, j = column // 2, column % 2
            for a in range(0, 8, 2):
                at = (64 * e + 8 * a + b) * lanes
                x0, x1 = (
                    by_acceleration * load(masses, at, lane),
                    by_acceleration * load(masses, at + 8 * lanes, lane),
                )
                y0, y1 = none, none
                if j == 1:
                    x0, x1, y0, y1 = none, none, x0, x1
                for g in range(points):
                    h0, h1, h2, h3 = four(half, (column * points + g) * 4 * lanes, lane)
                    dx, dy = gradients[e, g, a, 0], gradients[e, g, a, 1]
                    x0, y0 = x0 + dx * h0 + dy * h1, y0 + dx * h2 + dy * h3
                    dx, dy = gradients[e, g, a + 1, 0], gradients[e, g, a + 1, 1]
                    x1, y1 = x1 + dx * h0 + dy * h1, y1 + dx * h2 + dy * h3
                row, to = 2 * elements[e, a], 2 * elements[e, b] + j
                at = (row * (width - 1) + diagonal + to) * lanes
                add(band, at, x0)
                add(band, at + (width - 1) * lanes, y0)
                row = 2 * elements[e, a + 1]
                at = (row * (width - 1) + diagonal + to) * lanes
                add(band, at, x1)
                add(band, at + (width - 1) * lanes, y1)


@njit(cache=True, fastmath=True, error_model="numpy")
def scatter_directions(
    moduli: np.ndarray,
    elements: np.ndarray,
    gradients: np.ndarray,
    areas: np.ndarray,
    stretch: np.ndarray,
    directions: np.ndarray,
    force: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Add to force [columns, nodes, 2, lanes] the change of the nodal forces along many directions at once.

    moduli: [elements, points, 4, 4, lanes], by F or by its rate; directions: of the nodal positions or velocities
    [columns, nodes, 2, lanes].
    """
    lanes, points, nodes = len(lane), areas.shape[1], directions.shape[1]
    local, here = np.empty(16 * lanes), np.empty(16 * lanes)
    for e in range(elements.shape[0]):
        for column in range(directions.shape[0]):
            local[:] = 0.0
            for a in range(8):
                at = 2 * lanes * (column * nodes + elements[e, a])
                store(here, 2 * a * lanes, load(directions, at, lane))
                store(here, (2 * a + 1) * lanes, load(directions, at + lanes, lane))
            for g in range(points):
                point = e * points + g
                d0, d1, d2, d3 = zero(lane), zero(lane), zero(lane), zero(lane)
                for a in range(8):
                    dx, dy = gradients[e, g, a, 0], gradients[e, g, a, 1]
                    x, y = load(here, 2 * a * lanes, lane), load(here, (2 * a + 1) * lanes, lane)
                    d0, d1, d2, d3 = d0 + x * dx, d1 + x * dy, d2 + y * dx, d3 + y * dy
                along = load(stretch, point * lanes, lane)
                d0, d2 = d0 / along, d2 / along
                p0, p1, p2, p3 = product(moduli, 16 * point * lanes, (d0, d1, d2, d3), lane)
                area = areas[e, g]
                add_stress(local, (p0, p1, p2, p3), gradients, e, g, area, area * along, lane)
            add_to_nodes(local, elements, e, column * nodes, force, lane)


@njit(cache=True, fastmath=True, error_model="numpy")
def transpose_moduli(moduli: np.ndarray, out: np.ndarray, lane: LaneTuple) -> None:
    """Exchange the rows and columns of moduli [elements, points, 4, 4, lanes]."""
    lanes = len(lane)
    for point in range(moduli.shape[0] * moduli.shape[1]):
        for i in range(4):
            for j in range(4):
                store(
                    out,
                    (16 * point + 4 * i + j) * lanes,
                    load(moduli, (16 * point + 4 * j + i) * lanes, lane),
                )


@njit(cache=True, fastmath=True, error_model="numpy")
def contraction_force(
    F: np.ndarray,
    coefficients: np.ndarray,
    muscle: np.ndarray,
    elements: np.ndarray,
    gradients: np.ndarray,
    areas: np.ndarray,
    force: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Derivative of the internal force by the contraction of each muscle, into force [muscles, nodes, 2, lanes]."""
    lanes, points, nodes = len(lane), areas.shape[1], force.shape[1]
    force[:] = 0.0
    for e in range(elements.shape[0]):
        if muscle[e] == 0:
            continue
        w = load(coefficients, (COEFFICIENTS * e + FIBRE) * lanes, lane)
        for g in range(points):
            at = 4 * lanes * (e * points + g)
            a, c = load(F, at, lane), load(F, at + 2 * lanes, lane)
            pull = areas[e, g] * w / square_root(a * a + c * c)
            for n in range(8):
                dx = gradients[e, g, n, 0]
                at = 2 * lanes * ((muscle[e] - 1) * nodes + elements[e, n])
                add(force, at, pull * a * dx)
                add(force, at + lanes, pull * c * dx)


@njit(cache=True, fastmath=True, error_model="numpy")
def mass_product(
    masses: np.ndarray, elements: np.ndarray, columns: np.ndarray, out: np.ndarray, lane: LaneTuple
) -> None:
    """Add to out [columns, nodes, 2, lanes] the element masses [elements, 8, 8, lanes] times the nodal vectors."""
    lanes, nodes = len(lane), columns.shape[1]
    for e in range(elements.shape[0]):
        for column in range(columns.shape[0]):
            for a in range(8):
                x, y = zero(lane), zero(lane)
                for b in range(8):
                    mass = load(masses, (64 * e + 8 * a + b) * lanes, lane)
                    at = 2 * lanes * (column * nodes + elements[e, b])
                    x, y = x + mass * load(columns, at, lane), y + mass * load(columns, at + lanes, lane)
                at = 2 * lanes * (column * nodes + elements[e, a])
                add(out, at, x)
                add(out, at + lanes, y)


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


SitesOfLoops = tuple[SiteGroups, np.ndarray, np.ndarray]
"""`sites` of the compiled loops: with the site matrices by value and by tangent [sites, 2, 2, lanes]."""


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
def _summed(
    products: np.ndarray, place: int, matrices: np.ndarray, first: int, count: int, lane: LaneTuple
) -> Four:
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
def _add_block(band: np.ndarray, at: int, below: int, block: Four, lane: LaneTuple) -> None:
    """Add two rows of two components, the second `below` the first."""
    lanes, (xx, xy, yx, yy) = len(lane), block
    add(band, at, xx)
    add(band, at + lanes, xy)
    add(band, at + below, yx)
    add(band, at + below + lanes, yy)


@njit(cache=True, fastmath=True, error_model="numpy")
def add_site_matrix(sites: SitesOfLoops, band: np.ndarray, diagonal: int, lane: LaneTuple) -> None:
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
