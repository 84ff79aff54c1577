# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The derivatives of a step by all parameters at once, and the way back through it; each one compiled call.

With A the matrix of the step and s the change of the positions at the balance that the derivatives before the step
bring: A (s / c), c being the weight of the end-of-step acceleration in these positions, stands for the stiffness, so
that only damping, inertia and what a parameter changes at a fixed motion are left on the right-hand side. One
factorisation of A serves the columns of all parameters (direct differentiation; e.g. Michaleris, Tortorelli and Vidal,
Int. J. Numer. Methods Eng. 37 (1994) 2471); they are exact to the tolerance of the steps.

The tuples are those of `time_loop` and `balance`.
"""

from collections.abc import Sequence

import numpy as np
from numba import njit

from hasel_sim.dynamics.column_loops import (
    Columns,
    MemoryOfLoops,
    add_branch_columns,
    add_laws_by_contraction,
    add_residual_columns,
)
from hasel_sim.dynamics.generalised_alpha import StepCoefficients
from hasel_sim.dynamics.parameter_columns import ResidualColumns, ResidualSlope
from hasel_sim.dynamics.system import System
from hasel_sim.laws.tape_loops import Tables, Terms, add_slopes, respond, subtract_directions
from hasel_sim.mechanics.assembly import SitesOfLoops, add_site_matrix, add_stress, add_to_nodes, product
from hasel_sim.mechanics.balance import Body, DriveOfLoops, Further, SolidOfLoops, balance
from hasel_sim.mechanics.banded import (
    MatrixOfLoops,
    clear_band,
    factorise,
    is_spoilt,
    solve,
    solve_transposed,
)
from hasel_sim.mechanics.branches import advance_stresses, carried_columns, green_along
from hasel_sim.mechanics.constitutive import COEFFICIENTS, deformation
from hasel_sim.mechanics.state import Fields, StateSlopes, chosen_of, combine, copy_lanes, difference
from hasel_sim.simd import LaneTuple, add, four, load, square_root, store, three, zero

Laws = tuple[Terms, Tables, np.ndarray]
Scheme = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]
Progress = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
_NodalRoom = tuple[np.ndarray, ...]
_Slopes = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]
_Room = tuple[_NodalRoom, tuple[np.ndarray, ...], np.ndarray, np.ndarray, np.ndarray, np.ndarray]
Derivatives = tuple[_Slopes, np.ndarray, Columns, _Room]
"""The tuples of `time_loop`."""
_AtStep = tuple[
    Fields,
    np.ndarray,
    Body,
    DriveOfLoops,
    tuple[SitesOfLoops, Further, np.ndarray],
    tuple[np.ndarray, np.ndarray],
    MatrixOfLoops,
]
"""A step as `pull_back` takes it: motion, weights of the matrix, body, drive, laws, room for residual and stress."""


@njit(cache=True, fastmath=True, error_model="numpy")
def directions(slopes: Fields, weights: np.ndarray, out: Fields, lane: LaneTuple) -> None:
    """Changes of velocity and acceleration at the balance, less what A (s / c) has of them; A's own share comes last.

    slopes: derivatives of position, velocity and acceleration before the step, out: three arrays, all
    [columns, nodes, 2, lanes].
    """
    position, velocity, acceleration = slopes
    rate, inertia, instead = out
    lanes = len(lane)
    xv, xa, xn, va = four(weights, 0, lane)
    vn, aa, an, _ = four(weights, 4 * lanes, lane)
    for at in range(0, position.size, lanes):
        x, v, a = load(position, at, lane), load(velocity, at, lane), load(acceleration, at, lane)
        own = (x + xv * v + xa * a) / xn
        store(instead, at, own)
        store(rate, at, v + va * a - vn * own)
        store(inertia, at, aa * a - an * own)


@njit(cache=True, fastmath=True, error_model="numpy")
def right_hand_sides(
    position: np.ndarray,
    body: Body,
    drive: DriveOfLoops,
    moved: tuple[np.ndarray, np.ndarray],
    by_contraction: np.ndarray,
    stress: np.ndarray,
    further: tuple[np.ndarray, np.ndarray],
    out: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Add to out [columns, nodes or more, 2, lanes] what damping, inertia, contraction and further stress change.

    position: at the balance; body, drive: as in `integrate` and `balance`; moved: changes of velocity and acceleration
    [columns, nodes, 2, lanes]; by_contraction: of the contraction [columns, 1 + muscles, lanes]; stress: of the second
    Piola stress [columns, elements, points, 3, lanes] or an empty first axis; further: place of every element among
    those whose further stress depends on the rate or -1 [elements], and how [n, points, 4, 4, lanes].
    """
    (elements, gradients, areas, stretch, muscle, _), masses, _ = body
    table, _, _ = drive
    rate, inertia = moved
    places, further_by_rate = further
    lanes, count, points, nodes = len(lane), elements.shape[0], areas.shape[1], rate.shape[1]
    muscles = by_contraction.shape[1]
    none = zero(lane)
    F, pull = np.empty(4 * points * lanes), np.empty(points * lanes)
    v, force = np.empty(16 * lanes), np.empty(16 * lanes)
    for e in range(count):
        own = COEFFICIENTS * lanes * e
        _, _, mu, lam = four(table, own, lane)
        _, _, w = three(table, own + 4 * lanes, lane)
        for g in range(points):
            a, b, c, d = none, none, none, none
            for n in range(8):
                at, dx, dy = 2 * lanes * elements[e, n], gradients[e, g, n, 0], gradients[e, g, n, 1]
                x, y = load(position, at, lane), load(position, at + lanes, lane)
                a, b, c, d = a + x * dx, b + x * dy, c + y * dx, d + y * dy
            shrink, at = 1.0 / load(stretch, (e * points + g) * lanes, lane), 4 * g * lanes
            a, c = a * shrink, c * shrink
            store(F, at, a)
            store(F, at + lanes, b)
            store(F, at + 2 * lanes, c)
            store(F, at + 3 * lanes, d)
            store(pull, g * lanes, w / square_root(a * a + c * c))
        for column in range(rate.shape[0]):
            for n in range(8):
                at, to = 2 * lanes * (column * nodes + elements[e, n]), 2 * lanes * n
                store(v, to, load(rate, at, lane))
                store(v, to + lanes, load(rate, at + lanes, lane))
                store(force, to, none)
                store(force, to + lanes, none)
            for n in range(8):
                at = 2 * lanes * (column * nodes + elements[e, n])
                ax, ay = load(inertia, at, lane), load(inertia, at + lanes, lane)
                for m in range(8):
                    mass = load(masses, (64 * e + 8 * n + m) * lanes, lane)
                    add(force, 2 * m * lanes, mass * ax)
                    add(force, (2 * m + 1) * lanes, mass * ay)
            contracted = load(by_contraction, (column * muscles + muscle[e]) * lanes, lane)
            for g in range(points):
                point = e * points + g
                along, area = load(stretch, point * lanes, lane), areas[e, g]
                a, b, c, d = four(F, 4 * g * lanes, lane)
                p, q, r, s = none, none, none, none
                for n in range(8):
                    dx, dy = gradients[e, g, n, 0], gradients[e, g, n, 1]
                    x, y = load(v, 2 * n * lanes, lane), load(v, (2 * n + 1) * lanes, lane)
                    p, q, r, s = p + x * dx, q + x * dy, r + y * dx, s + y * dy
                shrink = 1.0 / along
                p, r = p * shrink, r * shrink
                xx, yy = a * p + c * r, b * q + d * s
                sxx, syy = lam * (xx + yy) + 2.0 * mu * xx, lam * (xx + yy) + 2.0 * mu * yy
                sxy = mu * (a * q + b * p + c * s + d * r)
                if stress.shape[0] > 0:
                    hxx, hyy, hxy = three(stress, 3 * lanes * (column * count * points + point), lane)
                    sxx, syy, sxy = sxx + hxx, syy + hyy, sxy + hxy
                p0, p1, p2, p3 = a * sxx + b * sxy, a * sxy + b * syy, c * sxx + d * sxy, c * sxy + d * syy
                if muscle[e] != 0:
                    more = contracted * load(pull, g * lanes, lane)
                    p0, p2 = p0 + more * a, p2 + more * c
                if places[e] >= 0:
                    at = 16 * lanes * (places[e] * points + g)
                    m0, m1, m2, m3 = product(further_by_rate, at, (p, q, r, s), lane)
                    p0, p1, p2, p3 = p0 + m0, p1 + m1, p2 + m2, p3 + m3
                add_stress(force, (p0, p1, p2, p3), gradients, e, g, area, area * along, lane)
            add_to_nodes(force, elements, e, column * out.shape[1], out, lane)


@njit(cache=True, fastmath=True, error_model="numpy")
def advance_columns(
    slopes: Fields,
    instead: np.ndarray,
    solution: np.ndarray,
    to_end: np.ndarray,
    chosen: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Bring the derivatives of position, velocity and acceleration to the end of the step in the lanes chosen [lanes].

    instead: A's own share [columns, nodes, 2, lanes]; solution: of the right-hand sides [columns, more, 2, lanes].
    """
    position, velocity, acceleration = slopes
    lanes = len(lane)
    size, height = 2 * position.shape[1] * lanes, 2 * solution.shape[1] * lanes
    xv, xa, xn, va = four(to_end, 0, lane)
    vn = load(to_end, 4 * lanes, lane)
    for c in range(position.shape[0]):
        for at in range(c * size, (c + 1) * size, lanes):
            x, v, a = load(position, at, lane), load(velocity, at, lane), load(acceleration, at, lane)
            new = zero(lane) - load(instead, at, lane) - load(solution, at + c * (height - size), lane)
            store(position, at, chosen_of(x + xv * v + xa * a + xn * new, x, chosen, lane))
            store(velocity, at, chosen_of(v + va * a + vn * new, v, chosen, lane))
            store(acceleration, at, chosen_of(new, a, chosen, lane))


@njit(inline="always")
def _motion(
    before: Fields,
    new: np.ndarray,
    to_balance: np.ndarray,
    chosen: np.ndarray,
    room: _NodalRoom,
    lane: LaneTuple,
) -> None:
    """The motion at the balance of a step that ends with an acceleration; in lanes not chosen one that is known."""
    x, v, a, end, _, _ = room
    for at in range(0, new.size, len(lane)):
        store(end, at, chosen_of(load(new, at, lane), load(before[2], at, lane), chosen, lane))
    combine(before[0], before[1], before[2], end, to_balance, x, v, a, lane)


@njit(inline="always")
def _laws(
    laws: Laws,
    motion: Fields,
    solid: SolidOfLoops,
    signals: np.ndarray,
    weights: np.ndarray,
    only_rate: np.ndarray,
    by_rate: np.ndarray,
    lane: LaneTuple,
) -> None:
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
def _matrix(
    motion: Fields,
    weights: np.ndarray,
    body: Body,
    drive: DriveOfLoops,
    terms: Terms,
    found: np.ndarray,
    residual: np.ndarray,
    matrix: MatrixOfLoops,
    bad: np.ndarray,
    lane: LaneTuple,
) -> None:
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
def _advance_branches(
    before: Fields,
    memory: MemoryOfLoops,
    kind: int,
    scheme: Scheme,
    solid: SolidOfLoops,
    columns: Columns,
    slopes: _Slopes,
    room: _NodalRoom,
    chosen: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Bring the derivatives of the branches' stresses to the end of a step, those of the positions being there."""
    x, v, a, end, branch, green = room
    combine(before[0], before[1], before[2], end, scheme[2][kind], x, v, a, lane)
    elements, gradients, areas, stretch, _, _ = solid
    shear, lame = memory[6]
    F = np.empty((*areas.shape, 4, len(lane)))
    deformation(x, elements, gradients, stretch, F, lane)
    green_along(slopes[0], F, solid[:4], shear, lame, green, lane)
    advance_stresses(memory[4][kind], memory[5][kind], slopes[3], slopes[4], green, branch, lane)
    add_branch_columns(columns, kind, x, elements, F, memory, branch, green, lane)
    copy_lanes(green, slopes[4], chosen, lane)
    copy_lanes(branch, slopes[3], chosen, lane)


@njit(inline="always")
def differentiate(
    before: Fields,
    new: np.ndarray,
    kind: int,
    scheme: Scheme,
    drive: DriveOfLoops,
    body: Body,
    matrix: MatrixOfLoops,
    laws: Laws,
    memory: MemoryOfLoops,
    expected: np.ndarray,
    derivatives: tuple[_Slopes, np.ndarray, Columns, _Room, tuple[np.ndarray, np.ndarray]],
    progress: Progress,
    lane: LaneTuple,
) -> None:
    """Bring the derivatives of the state to the end of a step, in place, in the lanes that made it.

    before, new: position, velocity and acceleration before the step, and the acceleration after it; drive: as in
    `balance`; expected: see `newton`; derivatives: those of the state, of the contraction, `columns`, room, see
    `StepSlopes`, and room for the residual and for the stress.
    """
    slopes, by_contraction, columns, (nodal, moved, right, carried, only_rate, by_rate), found = derivatives
    x, v, a, _, _, _ = nodal
    _, arrived, due, _ = progress
    bad = np.full(len(lane), -1)
    solid, weights, signals = body[0], scheme[1][kind], drive[1]
    motion = x, v, a
    _motion(before, new, scheme[0][kind], arrived, nodal, lane)
    _laws(laws, motion, solid, signals, weights, only_rate, by_rate, lane)
    _matrix(motion, weights, body, drive, laws[0], found[1], found[0], matrix, bad, lane)
    copy_lanes(found[1], expected, due, lane)
    due[:] = False

    moving = slopes[0], slopes[1], slopes[2]
    directions(moving, scheme[0][kind], moved, lane)
    if carried.shape[0] > 0:
        carried_columns(memory[2][kind], memory[3][kind], slopes[3], slopes[4], carried, lane)
    right[:] = 0.0
    further = laws[0][2][0], by_rate
    rates = moved[0], moved[1]
    right_hand_sides(x, body, drive, rates, by_contraction, carried, further, right, lane)
    subtract_directions(laws[1], laws[2], moved[0], moved[1], right, lane)
    add_laws_by_contraction(columns, motion, solid, signals, by_contraction, right, lane)
    add_residual_columns(columns, kind, motion, solid, signals, memory, 1.0, right, lane)
    solve(matrix, right, lane)
    matrix[3][0] = matrix[3][0] or is_spoilt(right[0], len(matrix[1]), bad)
    advance_columns(moving, moved[2], right, scheme[2][kind], arrived, lane)
    if carried.shape[0] > 0:
        _advance_branches(before, memory, kind, scheme, solid, columns, slopes, nodal, arrived, lane)


@njit(cache=True, error_model="numpy")
def pull_back(
    at_step: _AtStep,
    weights: np.ndarray,
    moved: tuple[np.ndarray, np.ndarray],
    by_contraction: np.ndarray,
    carried: np.ndarray,
    pulled: np.ndarray,
    bad: np.ndarray,
    lane: LaneTuple,
) -> None:
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
    right_hand_sides(motion[0], body, drive, moved, by_contraction, carried, places, pulled, lane)


class StepSlopes:
    """Columns of a `System`'s parameters, beside its steps.

    by_rate: room for the derivative of the further stress by the rate, see `LawTable`; more: nodes behind those of the
    mesh that a right-hand side has.
    """

    def __init__(
        self, system: System, parameters: Sequence[ResidualSlope], by_rate: np.ndarray, more: int
    ) -> None:
        self.columns = ResidualColumns(system, parameters)
        nodal, points, lanes = system.weight.shape, system.solid.areas.shape, system.lanes
        branches, count = len(system.solid.branches), len(parameters)
        stress = (count if branches else 0, *points, 3, lanes)
        self._none = np.zeros((0, branches, *points, 3, lanes)), np.zeros((0, *points, 3, lanes))
        self._room = (
            (
                *(np.zeros(nodal) for _ in range(4)),
                np.zeros((stress[0], branches, *points, 3, lanes)),
                np.zeros(stress),
            ),
            tuple(np.zeros((count, *nodal)) for _ in range(3)),
            np.zeros((count, nodal[0] + more, 2, lanes)),
            np.zeros(stress),
            np.array([0.0, 1.0, 0.0])[:, None] * np.ones(lanes),
            by_rate,
        )

    def __len__(self) -> int:
        return len(self.columns)

    def plan(
        self, slopes: StateSlopes, by_contraction: np.ndarray, coefficients: Sequence[StepCoefficients]
    ) -> Derivatives:
        """What `integrate` takes of derivatives that are moved in place from now on.

        by_contraction: derivatives of the contraction at every step [steps, columns, muscles, lanes].
        """
        lanes = by_contraction.shape[-1]
        every = np.concatenate([np.zeros_like(by_contraction[:, :, :1]), by_contraction], axis=2)
        steps = [(np.broadcast_to(c.at, lanes), np.broadcast_to(c.step, lanes)) for c in coefficients]
        branch, green = self._none if slopes.branch is None else (slopes.branch, slopes.green)
        moving = slopes.position, slopes.velocity, slopes.acceleration, branch, green
        return moving, every + self.columns.contraction, self.columns.table(steps), self._room
