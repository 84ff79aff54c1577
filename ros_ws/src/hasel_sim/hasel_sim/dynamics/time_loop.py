# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The time loop: steps of the bodies in all lanes, one after the other, each found by Newton's method; compiled.

A step is made with one matrix, that of the guess: a correction that is not small enough is followed by others with the
same factors, a quarter as dear. The tuples that the functions share:
`body`: solid as in `balance`, element masses, weight.
`matrix`: band, reach, (diagonal, half bandwidth, held unknowns), whether factors that are no numbers lie in it [1].
`laws`: what effects add, (nodal forces, sites of `assembly`, further stress of `balance`), and what finds it: the
tables and laws of `tape_loops.respond`.
`scheme`: weights of every kind of step, first axis: to the balance, of the matrix, to the end, of the acceleration in
the end position, length.
`memory`: internal branches: stresses, C : E, what a step leaves and adds up to the balance and up to its end, moduli.
`progress`: which lanes are to make a step, which made it, whose stress is still due, their last correction [lanes].
`derivatives`: of the state (positions, velocities, accelerations, branches' stresses, C : E) with the columns first, of
the contraction at every step, `columns` of `column_loops`, and room, see `step_derivatives.StepSlopes`; none where no
columns are wanted.
`room`: arrays to work in.
"""

import numpy as np
from numba import njit

from hasel_sim.dynamics.column_loops import MemoryOfLoops
from hasel_sim.dynamics.step_derivatives import Derivatives, Laws, Progress, Scheme, differentiate
from hasel_sim.laws.tape_loops import respond
from hasel_sim.mechanics.assembly import add_site_matrix
from hasel_sim.mechanics.balance import Body, DriveOfLoops, SolidOfLoops, balance
from hasel_sim.mechanics.banded import MatrixOfLoops, clear_band, factorise, is_spoilt, solve
from hasel_sim.mechanics.branches import carried
from hasel_sim.mechanics.constitutive import deformation, green_stress
from hasel_sim.mechanics.state import Fields, chosen_of, combine, copy_lanes, difference, subtract_lanes
from hasel_sim.simd import LaneTuple, load, store

PREDICT, BALANCE, DIFFERENTIATE, COMMIT = 1, 2, 4, 8
MOST_WITH_ONE_MATRIX, MOST_ITERATIONS = 5, 15
SLOW_WITH_ONE_MATRIX, SLOW = 0.1, 1.0
"""Corrections that do not shrink to this share of the last, with one matrix: in the mean, want another way."""
_Moving = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
_Plan = tuple[np.ndarray, Scheme, np.ndarray, np.ndarray, np.ndarray]
_Room = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]
_Rules = tuple[tuple[float, float], tuple[int, int, bool, bool]]


@njit(cache=True, error_model="numpy")
def _judge(
    iteration: int,
    always: bool,
    vector: np.ndarray,
    unknowns: int,
    end_position: np.ndarray,
    bad: np.ndarray,
    progress: Progress,
    taken: np.ndarray,
    limits: tuple[float, float],
) -> None:
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


@njit(inline="always")
def newton(
    before: Fields,
    guess: np.ndarray,
    kind: int,
    scheme: Scheme,
    body: Body,
    matrix: MatrixOfLoops,
    drive: DriveOfLoops,
    laws: Laws,
    expected: np.ndarray,
    room: _Room,
    progress: Progress,
    rules: _Rules,
    lane: LaneTuple,
) -> None:
    """Correct a guess of the end-of-step acceleration in the lanes wanted; those that fail are wanted no more.

    expected: second Piola stress of the last balance, replaced by that of this one in the lanes that arrive.
    rules: limits, see `_judge`; (the first of the iterations to make, the one to end before, whether each has a matrix
    of its own, whether the stress of lanes that arrived with their first correction is left to what follows).
    """
    to_balance, matrix_weights, _, end_position, _ = scheme
    solid, masses, weight = body
    terms, tapes, programs = laws
    forces, sites, further = terms
    x, v, a, vector, found, _, _ = room
    band, reach, (diagonal, _, _), spoilt = matrix
    wanted, arrived, due, _ = progress
    limits, (first, last, always, leave) = rules
    weights = matrix_weights[kind]
    bad, taken = np.full(len(lane), -1), np.zeros(len(lane), dtype=np.bool_)
    for iteration in range(first, last):
        more = (wanted & ~arrived).any()
        if not more and (leave or not due.any()):
            break
        fresh = more and (iteration == 0 or always)
        combine(before[0], before[1], before[2], guess, to_balance[kind], x, v, a, lane)
        if programs.shape[0] > 0:
            respond(tapes, programs, fresh, (x, v, a), solid[:4], drive[1], weights, terms, lane)
        difference(forces, weight, vector, lane)
        if fresh and spoilt[0]:
            band[:] = 0.0
        elif fresh:
            clear_band(band, reach, diagonal, lane)
        motion, out = (x, v, a), (vector, found, band, diagonal)
        balance(motion, solid, drive, further, masses, weights, expected, (fresh, iteration == 0), out, lane)
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


@njit(cache=True, fastmath=True, error_model="numpy")
def _advance_branches(
    memory: MemoryOfLoops, kind: int, new_green: np.ndarray, chosen: np.ndarray, lane: LaneTuple
) -> None:
    """Bring the branches to the end of a step, in the lanes chosen."""
    stresses, green, _, _, left, gain, _ = memory
    lanes, branches = len(lane), left.shape[1]
    for at in range(0, green.size, lanes):
        more = load(new_green, at, lane) - load(green, at, lane)
        for b in range(branches):
            factor, place = (kind * branches + b) * lanes, b * green.size + at
            old = load(stresses, place, lane)
            new = load(left, factor, lane) * old + load(gain, factor, lane) * more
            store(stresses, place, chosen_of(new, old, chosen, lane))
    copy_lanes(new_green, green, chosen, lane)


@njit(inline="always")
def _predict(moving: _Moving, kind: int, step: np.ndarray, guess: np.ndarray, lane: LaneTuple) -> None:
    """Extrapolate the acceleration into `guess`."""
    _, _, acceleration, jerk = moving
    lanes = len(lane)
    for at in range(0, guess.size, lanes):
        value = load(acceleration, at, lane) + load(step, kind * lanes, lane) * load(jerk, at, lane)
        store(guess, at, value)


@njit(inline="always")
def _commit(
    moving: _Moving,
    kind: int,
    scheme: Scheme,
    solid: SolidOfLoops,
    memory: MemoryOfLoops,
    guess: np.ndarray,
    room: _Room,
    chosen: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Go to the end of a step in the lanes chosen [lanes], which know its acceleration; the others stay."""
    position, velocity, acceleration, jerk = moving
    _, _, to_end, _, step = scheme
    x, v, a, _, _, strain, green = room
    combine(position, velocity, acceleration, guess, to_end[kind], x, v, a, lane)
    lanes = len(lane)
    for at in range(0, guess.size, lanes):
        change = load(guess, at, lane) - load(acceleration, at, lane)
        new = change / load(step, kind * lanes, lane)
        store(jerk, at, chosen_of(new, load(jerk, at, lane), chosen, lane))
    copy_lanes(x, position, chosen, lane)
    copy_lanes(v, velocity, chosen, lane)
    copy_lanes(guess, acceleration, chosen, lane)
    if memory[2].shape[1] > 0:
        elements, gradients, _, stretch, _, _ = solid
        shear, lame = memory[6]
        deformation(position, elements, gradients, stretch, strain, lane)
        green_stress(strain, shear, lame, green, lane)
        _advance_branches(memory, kind, green, chosen, lane)


@njit(inline="always")
def _note(
    position: np.ndarray,
    slopes: np.ndarray,
    trajectories: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray],
    boundary: int,
    lane: LaneTuple,
) -> None:
    """Keep the positions at a boundary between steps: at the markers, and all of them where there is room.

    slopes: derivatives of the positions [columns, nodes, 2, lanes].
    """
    nodes, local, shapes, changes = trajectories
    lanes, to = len(lane), boundary * nodes.size * 2 * len(lane)
    for m in range(nodes.shape[0]):
        for n in range(nodes.shape[1]):
            at = 2 * lanes * nodes[m, n]
            store(local, to, load(position, at, lane))
            store(local, to + lanes, load(position, at + lanes, lane))
            to += 2 * lanes
    if shapes.shape[0] > 0:
        for at in range(0, position.size, lanes):
            store(shapes, boundary * position.size + at, load(position, at, lane))
    to = boundary * slopes.shape[0] * nodes.size * 2 * lanes
    for c in range(slopes.shape[0]):
        for node in nodes.flat:
            at = 2 * lanes * (c * slopes.shape[1] + node)
            store(changes, to, load(slopes, at, lane))
            store(changes, to + lanes, load(slopes, at + lanes, lane))
            to += 2 * lanes


@njit(cache=True, fastmath=True, error_model="numpy")
def integrate(
    parts: int,
    steps: tuple[int, int],
    rules: _Rules,
    moving: _Moving,
    plan: _Plan,
    body: Body,
    matrix: MatrixOfLoops,
    laws: Laws,
    memory: MemoryOfLoops,
    derivatives: Derivatives,
    history: np.ndarray,
    expected: np.ndarray,
    guess: np.ndarray,
    room: _Room,
    trajectories: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray],
    progress: Progress,
    lane: LaneTuple,
) -> int:
    """Make steps from the first until before the last of `steps`, or to one that fails in a lane: this step comes back.

    parts: which of PREDICT, BALANCE, DIFFERENTIATE and COMMIT to do; rules: see `newton`. moving: position, velocity,
    acceleration and its rate [nodes, 2, lanes]. plan: the kind of every step, `scheme`, the solid's coefficients for
    every kind, the drive [steps, 2 + 2 muscles, lanes] (see `DriveState.signals`), how many steps each lane makes
    [lanes]. Compiled as one function, which takes a third of the time that many take.
    """
    kinds, scheme, tables, signals, ends = plan
    wanted, arrived, due, _ = progress
    state = moving[0], moving[1], moving[2]
    slopes, by_contraction, columns, slope_room = derivatives
    for step in range(steps[0], steps[1]):
        kind = kinds[step]
        if parts & PREDICT:
            for k in range(len(ends)):
                wanted[k], arrived[k], due[k] = step < ends[k], False, False
            _predict(moving, kind, scheme[4], guess, lane)
            if memory[2].shape[1] > 0:
                carried(memory[2][kind], memory[3][kind], memory[0], memory[1], history, lane)
        drive = tables[min(kind, len(tables) - 1)], signals[step], history
        if parts & BALANCE:
            newton(
                state, guess, kind, scheme, body, matrix, drive, laws, expected, room, progress, rules, lane
            )
        if parts & DIFFERENTIATE and slopes[0].shape[0] > 0 and arrived.any():
            own = slopes, by_contraction[step], columns, slope_room, (room[3], room[4])
            differentiate(
                state, guess, kind, scheme, drive, body, matrix, laws, memory, expected, own, progress, lane
            )
        if parts & COMMIT:
            _commit(moving, kind, scheme, body[0], memory, guess, room, arrived, lane)
            _note(moving[0], slopes[0], trajectories, step + 1, lane)
            for k in range(len(ends)):
                if step < ends[k] and not arrived[k]:
                    return step
    return steps[1]
