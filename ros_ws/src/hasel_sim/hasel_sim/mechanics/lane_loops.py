"""Loops over nodal arrays [..., lanes]: weighted sums, and what acts on some of the lanes only."""

from numba import njit

from hasel_sim.simd import four, load, of_lane, store, with_lane, zero


@njit(inline="always")
def chosen_of(new, old, chosen, lane):
    """New numbers in the lanes chosen [lanes], old ones in the others."""
    for k in range(len(lane)):
        if not chosen[k]:
            new = with_lane(new, k, of_lane(old, k))
    return new


@njit(cache=True, fastmath=True, error_model="numpy")
def copy_lanes(source, to, chosen, lane):
    """Copy the lanes chosen [lanes]."""
    for at in range(0, to.size, len(lane)):
        store(to, at, chosen_of(load(source, at, lane), load(to, at, lane), chosen, lane))


@njit(cache=True, fastmath=True, error_model="numpy")
def subtract_lanes(change, out, chosen, lane):
    """Subtract the beginning of an array from another in the lanes chosen [lanes]."""
    for at in range(0, out.size, len(lane)):
        step = chosen_of(load(change, at, lane), zero(lane), chosen, lane)
        store(out, at, load(out, at, lane) - step)


@njit(cache=True, fastmath=True, error_model="numpy")
def difference(more, less, out, lane):
    """The difference of two arrays at the beginning of another, zeros behind it."""
    for at in range(0, out.size, len(lane)):
        if at < more.size:
            store(out, at, load(more, at, lane) - load(less, at, lane))
        else:
            store(out, at, zero(lane))


@njit(cache=True, fastmath=True, error_model="numpy")
def combine(position, velocity, acceleration, new, weights, x, v, a, lane):
    """Weighted sums of nodal vectors [nodes, 2, lanes], as a time step needs them, into x, v and a.

    weights [8, lanes]: of the velocity, acceleration and new acceleration in x; of the two accelerations in v and in a;
    one more is not used.
    """
    lanes = len(lane)
    xv, xa, xn, va = four(weights, 0, lane)
    vn, aa, an, _ = four(weights, 4 * lanes, lane)
    for at in range(0, position.size, lanes):
        speed, old, now = load(velocity, at, lane), load(acceleration, at, lane), load(new, at, lane)
        store(x, at, load(position, at, lane) + xv * speed + xa * old + xn * now)
        store(v, at, speed + va * old + vn * now)
        store(a, at, aa * old + an * now)
