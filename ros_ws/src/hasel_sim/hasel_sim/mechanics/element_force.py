"""From the stress at Gauss points to forces at nodes, one element at a time; inlined into the compiled loops."""

from numba import njit

from hasel_sim.simd import add, four, load


@njit(inline="always")
def product(matrix, at, vector, lane):
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
def add_stress(local, P, gradients, e, g, area, wide, lane):
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
def add_to_nodes(local, elements, e, first, out, lane):
    """Add an element's forces [8, 2, lanes] to those of all nodes [columns, nodes, 2, lanes], from node `first` on."""
    lanes = len(lane)
    for n in range(8):
        at = 2 * lanes * (first + elements[e, n])
        add(out, at, load(local, 2 * n * lanes, lane))
        add(out, at + lanes, load(local, (2 * n + 1) * lanes, lane))
