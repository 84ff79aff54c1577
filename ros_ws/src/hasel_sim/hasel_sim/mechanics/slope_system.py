"""The derivatives of a step by all parameters at once, and the way back through it; each one compiled call.

The tuples are those of `march`, `balance` and `slope_loops`.
"""

import numpy as np
from numba import njit

from hasel_sim.mechanics import branch_loops, slope_loops
from hasel_sim.mechanics.balance import balance
from hasel_sim.mechanics.banded_lu import clear_band
from hasel_sim.mechanics.column_loops import (
    add_branch_columns,
    add_laws_by_contraction,
    add_residual_columns,
)
from hasel_sim.mechanics.lane_loops import chosen_of, combine, copy_lanes, difference
from hasel_sim.mechanics.law_terms import add_site_matrix
from hasel_sim.mechanics.newton import factorise, is_spoilt, solve, solve_transposed
from hasel_sim.mechanics.strain import deformation
from hasel_sim.mechanics.tape_loops import add_slopes, respond, subtract_directions
from hasel_sim.simd import load, store


@njit(inline="always")
def _motion(before, new, to_balance, chosen, room, lane):
    """The motion at the balance of a step that ends with an acceleration; in lanes not chosen one that is known."""
    x, v, a, end, _, _ = room
    for at in range(0, new.size, len(lane)):
        store(end, at, chosen_of(load(new, at, lane), load(before[2], at, lane), chosen, lane))
    combine(before[0], before[1], before[2], end, to_balance, x, v, a, lane)


@njit(inline="always")
def _laws(laws, motion, solid, signals, weights, only_rate, by_rate, lane):
    """Differentiate all laws; further stress by the rate alone into `by_rate`."""
    terms, tapes, programs = laws
    _, (_, by_value, by_tangent), (place, _, _) = terms
    if programs.shape[0] > 0:
        respond(tapes, programs, np.bool_(True), motion, solid[:4], signals, weights, terms, lane)
        by_rate[:] = 0.0
    for n in range(programs.shape[0]):
        first = programs[n, 2]
        if first < 0:
            add_slopes(tapes, programs[n, 1], first, place, only_rate, (by_value, by_tangent), by_rate, lane)


@njit(inline="always")
def _matrix(motion, weights, body, drive, terms, found, residual, matrix, bad, lane):
    """Factorise the exact matrix of a step at the motion that it found; its stress comes along."""
    forces, sites, further = terms
    band, reach, (diagonal, _, _), spoilt = matrix
    difference(forces, body[2], residual, lane)
    if spoilt[0]:
        band[:] = 0.0
    else:
        clear_band(band, reach, diagonal, lane)
    out = residual, found, band, diagonal
    balance(
        motion, body[0], drive, further, body[1], weights, found, (np.bool_(True), np.bool_(False)), out, lane
    )
    add_site_matrix(sites, band, diagonal, lane)
    factorise(matrix, bad, lane)


@njit(inline="always")
def _advance_branches(before, memory, kind, scheme, solid, columns, slopes, room, chosen, lane):
    """Bring the derivatives of the branches' stresses to the end of a step, those of the positions being there."""
    x, v, a, end, branch, green = room
    combine(before[0], before[1], before[2], end, scheme[2][kind], x, v, a, lane)
    elements, gradients, areas, stretch, _, _ = solid
    shear, lame = memory[6]
    F = np.empty((*areas.shape, 4, len(lane)))
    deformation(x, elements, gradients, stretch, F, lane)
    branch_loops.green_along(slopes[0], F, solid[:4], shear, lame, green, lane)
    branch_loops.advance(memory[4][kind], memory[5][kind], slopes[3], slopes[4], green, branch, lane)
    add_branch_columns(columns, kind, x, elements, F, memory, branch, green, lane)
    copy_lanes(green, slopes[4], chosen, lane)
    copy_lanes(branch, slopes[3], chosen, lane)


@njit(inline="always")
def differentiate(
    before,
    new,
    kind,
    scheme,
    drive,
    body,
    matrix,
    laws,
    memory,
    expected,
    derivatives,
    found,
    progress,
    bad,
    lane,
):
    """Bring the derivatives of the state to the end of a step, in place, in the lanes that made it.

    before, new: position, velocity and acceleration before the step, and the acceleration after it; drive: as in
    `balance`; expected: see `newton`; derivatives: those of the state, of the contraction, `columns`, and room, see
    `step_slopes.StepSlopes`; found: room for the residual and for the stress; bad [lanes]: see `banded_lu.factorise`.
    """
    slopes, by_contraction, columns, (nodal, moved, right, carried, only_rate, by_rate) = derivatives
    x, v, a, _, _, _ = nodal
    _, arrived, due, _ = progress
    solid, weights, signals = body[0], scheme[1][kind], drive[1]
    motion = x, v, a
    _motion(before, new, scheme[0][kind], arrived, nodal, lane)
    _laws(laws, motion, solid, signals, weights, only_rate, by_rate, lane)
    _matrix(motion, weights, body, drive, laws[0], found[1], found[0], matrix, bad, lane)
    copy_lanes(found[1], expected, due, lane)
    due[:] = False

    moving = slopes[0], slopes[1], slopes[2]
    slope_loops.directions(moving, scheme[0][kind], moved, lane)
    if carried.shape[0] > 0:
        branch_loops.history(memory[2][kind], memory[3][kind], slopes[3], slopes[4], carried, lane)
    right[:] = 0.0
    further = laws[0][2][0], by_rate
    rates = moved[0], moved[1]
    slope_loops.right_hand_sides(x, body, drive, rates, by_contraction, carried, further, right, lane)
    subtract_directions(laws[1], laws[2], moved[0], moved[1], right, lane)
    add_laws_by_contraction(columns, motion, solid, signals, by_contraction, right, lane)
    add_residual_columns(columns, kind, motion, solid, signals, memory, 1.0, right, lane)
    solve(matrix, right, lane)
    matrix[3][0] = matrix[3][0] or is_spoilt(right[0], len(matrix[1]), bad)
    slope_loops.advance(moving, moved[2], right, scheme[2][kind], arrived, lane)
    if carried.shape[0] > 0:
        _advance_branches(before, memory, kind, scheme, solid, columns, slopes, nodal, arrived, lane)


@njit(cache=True, error_model="numpy")
def pull_back(at_step, weights, moved, by_contraction, carried, pulled, bad, lane):
    """Solve with the transposed matrix of a step, and pull the solution back to the rate and to the acceleration.

    weights [1, more, 2, lanes]: of the end-of-step acceleration, replaced by the solution; moved: two arrays
    [2, nodes, 2, lanes], zero but for where the solution goes; by_contraction, carried: none; pulled
    [2, nodes, 2, lanes]: takes damping and mass times the solution, both matrices transposed.
    """
    motion, matrix_weights, body, drive, (sites, further, by_rate), (residual, stress), matrix = at_step
    terms = residual, sites, further
    _matrix(motion, matrix_weights, body, drive, terms, stress, residual, matrix, bad, lane)
    solve_transposed(matrix, weights, lane)
    nodes = pulled.shape[1]
    moved[0][0], moved[1][1] = weights[0, :nodes], weights[0, :nodes]
    pulled[:] = 0.0
    places = further[0], by_rate
    slope_loops.right_hand_sides(motion[0], body, drive, moved, by_contraction, carried, places, pulled, lane)
