"""Newton's method for the end-of-step acceleration in all lanes, compiled.

A step is made with one matrix, that of the guess: a correction that is not small enough is followed by others with the
same factors, a quarter as dear. The tuples are those of `march`.
"""

import numpy as np
from numba import njit

from hasel_sim.mechanics import banded_lu
from hasel_sim.mechanics.balance import balance
from hasel_sim.mechanics.lane_loops import combine, copy_lanes, difference, subtract_lanes
from hasel_sim.mechanics.law_terms import add_site_matrix
from hasel_sim.mechanics.tape_loops import respond
from hasel_sim.simd import store, zero

SLOW_WITH_ONE_MATRIX, SLOW = 0.1, 1.0
"""Corrections that do not shrink to this share of the last, with one matrix: in the mean, want another way."""


@njit(cache=True, error_model="numpy")
def _judge(iteration, always, vector, unknowns, end_position, bad, progress, taken, limits):
    """Which lanes take the correction in `vector`, and which arrive with it.

    limits: the tolerance [m], and the largest square of a correction with a fresh matrix that leaves no more than that.
    """
    wanted, arrived, due, last = progress
    tolerance, square = limits
    fresh, slow = iteration == 0 or always, SLOW if always else SLOW_WITH_ONE_MATRIX
    for k in range(len(last)):
        size = 0.0
        for node in range(unknowns // 2):
            for i in range(2):
                found = abs(vector[node, i, k])
                if not found <= size:
                    size = found
        size *= end_position[k]
        taken[k] = wanted[k] and not arrived[k] and bad[k] < 0 and np.isfinite(size)
        if iteration > 0 and size > tolerance and size > slow * last[k]:
            taken[k] = False
        if taken[k]:
            arrived[k] = size < tolerance or (fresh and size**2 < square)
            last[k] = size if fresh else max(size, slow * last[k])  # one that shrinks far lends to the next
        wanted[k] = wanted[k] and (taken[k] or arrived[k])
        due[k] = taken[k] and arrived[k]


@njit(cache=True, error_model="numpy")
def is_spoilt(vector, unknowns, bad):
    """Whether factors may have left what is no number beyond the band, where `clear_band` does not look."""
    spoilt = False
    for k in range(len(bad)):
        spoilt = spoilt or bad[k] >= 0 or not np.isfinite(vector[unknowns // 2 - 1, 1, k])
    return spoilt


@njit(cache=True, fastmath=True, error_model="numpy")
def factorise(matrix, bad, lane):
    """Replace a band matrix by its factors; bad [lanes]: see `banded_lu.factorise`."""
    band, reach, (diagonal, half_bandwidth, held), _ = matrix
    n, lanes = len(reach), len(lane)
    line = band.shape[1] * lanes
    for row in range(held, min(held + half_bandwidth, n)):
        for at in range(row * line, row * line + (diagonal + held - row) * lanes, lanes):
            store(band, at, zero(lane))
    for row in range(n, band.shape[0]):
        store(band, row * line + diagonal * lanes, zero(lane) + 1.0)
    banded_lu.factorise(band[held:], n - held, half_bandwidth, reach[held:], bad, lane)


@njit(inline="always")
def _unknowns_of(columns, c, unknowns, held, lane):
    """One right-hand side [1, unknowns and padding, lanes] from the first unknown that is not held, all others zero."""
    lanes = len(lane)
    height = 2 * columns.shape[1] * lanes
    for at in range(c * height, c * height + held * lanes, lanes):
        store(columns, at, zero(lane))
    for at in range(c * height + unknowns * lanes, (c + 1) * height, lanes):
        store(columns, at, zero(lane))
    own = columns.reshape(columns.shape[0], 2 * columns.shape[1], lanes)[c, held:]
    return own.reshape(1, own.shape[0], lanes)


@njit(cache=True, fastmath=True, error_model="numpy")
def solve(matrix, columns, lane):
    """Solve in place with the factors for right-hand sides [columns, nodes and padding, 2, lanes]."""
    band, reach, (_, half_bandwidth, held), _ = matrix
    n = len(reach)
    for c in range(columns.shape[0]):
        _unknowns_of(columns, c, n, held, lane)
    every = columns.reshape(columns.shape[0], 2 * columns.shape[1], len(lane))
    banded_lu.solve(band[held:], n - held, half_bandwidth, reach[held:], every, held, lane)


@njit(cache=True, fastmath=True, error_model="numpy")
def solve_transposed(matrix, columns, lane):
    """The same with the transposed matrix."""
    band, reach, (_, half_bandwidth, held), _ = matrix
    n = len(reach)
    for c in range(columns.shape[0]):
        own = _unknowns_of(columns, c, n, held, lane)
        banded_lu.solve_transposed(band[held:], n - held, half_bandwidth, reach[held:], own, lane)


@njit(cache=True, error_model="numpy")
def _wanted_yet(wanted, arrived):
    more = False
    for k in range(len(wanted)):
        more = more or (wanted[k] and not arrived[k])
    return more


@njit(inline="always")
def newton(
    before, guess, kind, scheme, body, matrix, drive, laws, expected, room, limits, progress, how, lane
):
    """Correct a guess of the end-of-step acceleration in the lanes wanted; those that fail are wanted no more.

    expected: second Piola stress of the last balance, replaced by that of this one in the lanes that arrive.
    how: (the first of the iterations to make, the one to end before, whether each has a matrix of its own, whether the
    stress of lanes that arrived with their first correction is left to what follows).
    """
    to_balance, matrix_weights, _, end_position, _ = scheme
    solid, masses, weight = body
    terms, tapes, programs = laws
    forces, sites, further = terms
    x, v, a, vector, found, _, _ = room
    band, reach, (diagonal, _, _), spoilt = matrix
    wanted, arrived, due, _ = progress
    first, last, always, leave = how
    bad, taken = np.full(len(lane), -1), np.zeros(len(lane), dtype=np.bool_)
    for iteration in range(first, last):
        more = _wanted_yet(wanted, arrived)
        if not more and (leave or not due.any()):
            break
        fresh = more and (iteration == 0 or always)
        combine(before[0], before[1], before[2], guess, to_balance[kind], x, v, a, lane)
        if programs.shape[0] > 0:
            weights = matrix_weights[kind]
            respond(tapes, programs, fresh, (x, v, a), solid[:4], drive[1], weights, terms, lane)
        difference(forces, weight, vector, lane)
        if fresh and spoilt[0]:
            band[:] = 0.0
        elif fresh:
            banded_lu.clear_band(band, reach, diagonal, lane)
        balance(
            (x, v, a),
            solid,
            drive,
            further,
            masses,
            matrix_weights[kind],
            expected,
            (fresh, iteration == 0),
            (vector, found, band, diagonal),
            lane,
        )
        copy_lanes(found, expected, due, lane)
        due[:] = False
        if not more:
            break
        bad[:] = -1
        if fresh:
            add_site_matrix(sites, band, diagonal, lane)
            factorise(matrix, bad, lane)
        solve(matrix, vector.reshape(1, *vector.shape), lane)
        if fresh:
            spoilt[0] = is_spoilt(vector, len(reach), bad)
        _judge(iteration, always, vector, len(reach), end_position[kind], bad, progress, taken, limits)
        subtract_lanes(vector, guess, taken, lane)
        if not fresh:
            copy_lanes(found, expected, due, lane)
            due[:] = False
