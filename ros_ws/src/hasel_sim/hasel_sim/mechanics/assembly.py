"""From Gauss points, elements and sites to nodal forces and the band matrix, and along given directions.

Every array has the lanes as its last axis (see `simd.py`) but those that describe the mesh: elements, gradients and
areas. `stretch` is that of the stress-free shape along the body: gradients by x shrink with it, areas grow. Indices of
a stress run 00, 01, 10, 11 (row-major).
"""

import numpy as np
from numba import njit

from hasel_sim.mechanics.constitutive import COEFFICIENTS, FIBRE
from hasel_sim.mechanics.element_force import add_stress, add_to_nodes, product
from hasel_sim.simd import add, four, load, square_root, store, three, zero


@njit(cache=True, fastmath=True, error_model="numpy")
def scatter_stress(P, elements, gradients, areas, stretch, force, lane):
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
    elastic, viscous, masses, weights, elements, gradients, areas, stretch, band, diagonal, lane
):
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
def scatter_directions(moduli, stress, elements, gradients, areas, stretch, directions, force, lane):
    """Add to force [columns, nodes, 2, lanes] the change of the nodal forces along many directions at once.

    moduli: [elements, points, 4, 4, lanes], by F or by its rate; directions: of the nodal positions or velocities
    [columns, nodes, 2, lanes]; stress: change of the first Piola stress that does not come from them,
    [columns, elements, points, 4, lanes], or an empty first axis for none.
    """
    lanes, points, count = len(lane), areas.shape[1], elements.shape[0]
    nodes = directions.shape[1]
    local, here = np.empty(16 * lanes), np.empty(16 * lanes)
    for e in range(count):
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
                if stress.shape[0] > 0:
                    s0, s1, s2, s3 = four(stress, 4 * lanes * (column * count * points + point), lane)
                    p0, p1, p2, p3 = p0 + s0, p1 + s1, p2 + s2, p3 + s3
                area = areas[e, g]
                add_stress(local, (p0, p1, p2, p3), gradients, e, g, area, area * along, lane)
            add_to_nodes(local, elements, e, column * nodes, force, lane)


@njit(cache=True, fastmath=True, error_model="numpy")
def transpose_moduli(moduli, out, lane):
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
def contraction_force(F, coefficients, muscle, elements, gradients, areas, force, lane):
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
def mass_product(masses, elements, columns, out, lane):
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
