"""What force effects add to the matrix of a step, in a compiled loop.

The sites of all of them stand in one list; `start` tells where the nodes of each begin.
"""

from numba import njit

from hasel_sim.simd import add, load


@njit(cache=True, fastmath=True, error_model="numpy")
def add_site_matrix(sites, band, diagonal, lane):
    """Add the site matrices [sites, 2, 2, lanes], by value and by tangent, to a band matrix."""
    start, nodes, shape, slope, weights, by_value, by_tangent = sites
    lanes, width = len(lane), band.shape[1]
    for s in range(len(start) - 1):
        for i in range(2):
            at = (4 * s + 2 * i) * lanes
            d0, d1 = load(by_value, at, lane), load(by_value, at + lanes, lane)
            t0, t1 = load(by_tangent, at, lane), load(by_tangent, at + lanes, lane)
            for a in range(start[s], start[s + 1]):
                weight, row = weights[a], 2 * nodes[a] + i
                for b in range(start[s], start[s + 1]):
                    value, tangent = weight * shape[b], weight * slope[b]
                    at = (row * (width - 1) + diagonal + 2 * nodes[b]) * lanes
                    add(band, at, value * d0 + tangent * t0)
                    add(band, at + lanes, value * d1 + tangent * t1)
