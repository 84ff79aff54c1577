"""Between nodes and the sites where forces act, for all lanes at once.

Fields are [columns, nodes or sites, 2, lanes]; nodes and weights [sites, nodes per site].
"""

from numba import njit

from hasel_sim.simd import add, load, store, zero


@njit(cache=True, fastmath=True, error_model="numpy")
def interpolate(field, nodes, weights, out, lane):
    """Write what the weights make of a nodal field at the sites."""
    lanes, to = len(lane), 0
    for c in range(field.shape[0]):
        for s in range(nodes.shape[0]):
            x, y = _at_site(field, c, s, nodes, weights, lane)
            store(out, to, x)
            store(out, to + lanes, y)
            to += 2 * lanes


@njit(cache=True, fastmath=True, error_model="numpy")
def spread(force, nodes, weights, out, lane):
    """Add forces at the sites, times the weights, to a nodal field."""
    lanes, at = len(lane), 0
    for c in range(force.shape[0]):
        for s in range(nodes.shape[0]):
            x, y = load(force, at, lane), load(force, at + lanes, lane)
            _add_at_nodes(x, y, c, s, nodes, weights, out, lane)
            at += 2 * lanes


@njit(cache=True, fastmath=True, error_model="numpy")
def subtract_products(field, slope, nodes, shape, weights, out, lane):
    """Subtract slope [sites, 2, 2, lanes] times the field at the sites, times the weights, from a nodal field."""
    lanes = len(lane)
    for c in range(field.shape[0]):
        for s in range(nodes.shape[0]):
            x, y = _at_site(field, c, s, nodes, shape, lane)
            at = 4 * s * lanes
            along = load(slope, at, lane) * x + load(slope, at + lanes, lane) * y
            across = load(slope, at + 2 * lanes, lane) * x + load(slope, at + 3 * lanes, lane) * y
            _add_at_nodes(-1.0 * along, -1.0 * across, c, s, nodes, weights, out, lane)


@njit(inline="always")
def _at_site(field, c, s, nodes, weights, lane):
    lanes, x, y = len(lane), zero(lane), zero(lane)
    for k in range(nodes.shape[1]):
        at = 2 * lanes * (c * field.shape[1] + nodes[s, k])
        x = x + weights[s, k] * load(field, at, lane)
        y = y + weights[s, k] * load(field, at + lanes, lane)
    return x, y


@njit(inline="always")
def _add_at_nodes(x, y, c, s, nodes, weights, out, lane):
    lanes = len(lane)
    for k in range(nodes.shape[1]):
        at = 2 * lanes * (c * out.shape[1] + nodes[s, k])
        add(out, at, weights[s, k] * x)
        add(out, at + lanes, weights[s, k] * y)
