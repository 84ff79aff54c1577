# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The compiled loops that do the programs of laws at all points, and add what they find to forces and stresses."""

import numpy as np
from numba import njit

from hasel_sim.laws.program import WIDTH, operate
from hasel_sim.mechanics.assembly import SitesOfLoops
from hasel_sim.mechanics.balance import Further
from hasel_sim.mechanics.state import Fields
from hasel_sim.mesh.mesh import Places
from hasel_sim.simd import LaneTuple, Value, add, load, store, zero

POSITION, VELOCITY, ACCELERATION, TANGENT, TANGENT_RATE, DEFORMATION, RATE, FIXED, OF_MUSCLE = range(9)
"""Where an input comes from."""
HEAD = 15
INPUTS, INPUTS_END, UNIFORM, UNIFORM_END, BEFORE, OPERATIONS, OPERATIONS_END, OUTPUTS = range(8)
OUTPUTS_END, POINTS, PER, NUMBERS, REALS, FOUND, CONSTANTS = range(8, HEAD)
"""What is noted of every program, see `Tapes`."""
Tables = tuple[
    np.ndarray,
    np.ndarray,
    np.ndarray,
    np.ndarray,
    np.ndarray,
    np.ndarray,
    np.ndarray,
    np.ndarray,
    np.ndarray,
    np.ndarray,
]
"""`tables` of the loops, see `Tapes`."""
Terms = tuple[np.ndarray, SitesOfLoops, Further]
"""`terms` of the loops, see `system.LawTable`."""


@njit(inline="always")
def _at_sites(
    field: np.ndarray,
    reals: np.ndarray,
    nodes: np.ndarray,
    weights: int,
    per: int,
    first: int,
    count: int,
    R: np.ndarray,
    to_x: int,
    to_y: int,
    lane: LaneTuple,
) -> None:
    """Interpolate a nodal field at sites, its components into registers."""
    lanes = len(lane)
    for s in range(count):
        x, y = zero(lane), zero(lane)
        for k in range((first + s) * per, (first + s + 1) * per):
            weight, at = reals[weights + k], 2 * nodes[k] * lanes
            x, y = x + weight * load(field, at, lane), y + weight * load(field, at + lanes, lane)
        store(R, to_x + s * lanes, x)
        store(R, to_y + s * lanes, y)


@njit(inline="always")
def _at_points(
    field: np.ndarray,
    component: int,
    mesh: Places,
    chosen: np.ndarray,
    per: int,
    first: int,
    count: int,
    R: np.ndarray,
    to: int,
    lane: LaneTuple,
) -> None:
    """One component of the gradient of a nodal field at Gauss points, into a register."""
    elements, gradients, _, stretch = mesh
    lanes, row, column = len(lane), component // 2, component % 2
    place, g = first // per, first % per - 1
    for s in range(count):
        g += 1
        if g == per:
            place, g = place + 1, 0
        e, total = chosen[place], zero(lane)
        for n in range(8):
            along = gradients[e, g, n, column]
            total = total + along * load(field, (2 * elements[e, n] + row) * lanes, lane)
        if column == 0:
            total = total / load(stretch, (e * per + g) * lanes, lane)
        store(R, to + s * lanes, total)


@njit(inline="always")
def _gather(
    tables: Tables,
    head: np.ndarray,
    n: int,
    motion: Fields,
    mesh: Places,
    signals: np.ndarray,
    first: int,
    count: int,
    lane: LaneTuple,
) -> None:
    """Write an input at some points into its register."""
    _, inputs, _, _, _, numbers, reals, _, _, R = tables
    source, component, lanes = inputs[n, 0], inputs[n, 1], len(lane)
    to, to_y = inputs[n, 2] * WIDTH, inputs[n, 3] * WIDTH
    points, per, places, weights = head[POINTS], head[PER], numbers[head[NUMBERS] :], head[REALS]
    field = motion[0]
    if source in (VELOCITY, TANGENT_RATE, RATE):
        field = motion[1]
    elif source == ACCELERATION:
        field = motion[2]
    if source in (TANGENT, TANGENT_RATE):
        weights += points * per
    if source <= TANGENT_RATE:
        _at_sites(field, reals, places, weights, per, first, count, R, to, to_y, lane)
    elif source <= RATE:
        _at_points(field, component, mesh, places, per, first, count, R, to, lane)
    elif source == FIXED:
        start = component + first * lanes
        for at in range(0, count * lanes, lanes):
            store(R, to + at, load(reals, start + at, lane))
    else:
        muscle = places[points // per :]
        for s in range(count):
            own = muscle[first + s]
            row = own + component if own > 0 else 0
            store(R, to + s * lanes, load(signals, row * lanes, lane))


@njit(cache=True, fastmath={"contract", "nsz"}, error_model="numpy")
def evaluate(
    tables: Tables, program: int, motion: Fields, mesh: Places, signals: np.ndarray, lane: LaneTuple
) -> None:
    """Do a program for all its points, and write its outputs.

    motion: position, velocity, acceleration [nodes, 2, lanes]; mesh: elements, gradients, areas, stretch; signals: the
    drive, see `DriveState.signals`.
    """
    heads, _, uniform, operations, outputs, _, _, constants, found, R = tables
    head, lanes = heads[program], len(lane)
    if head[OPERATIONS_END] < 0:
        return
    for n in range(head[UNIFORM], head[UNIFORM_END]):
        value = load(signals, uniform[n, 1] * lanes, lane)
        if uniform[n, 0] == 0:
            value = load(constants, uniform[n, 1] * lanes, lane)
        for at in range(uniform[n, 2] * WIDTH, (uniform[n, 2] + 1) * WIDTH, lanes):
            store(R, at, value)
    operate(operations, head[BEFORE], head[OPERATIONS], R)
    points, most, present = head[POINTS], WIDTH // lanes, load(constants, head[CONSTANTS] * lanes, lane)
    for first in range(0, points, most):
        count = min(most, points - first)
        for n in range(head[INPUTS], head[INPUTS_END]):
            _gather(tables, head, n, motion, mesh, signals, first, count, lane)
        operate(operations, head[OPERATIONS], head[OPERATIONS_END], R)
        for n in range(head[OUTPUTS], head[OUTPUTS_END]):
            to = head[FOUND] + (outputs[n, 0] * points + first) * lanes
            register = outputs[n, 1] * WIDTH
            for at in range(0, count * lanes, lanes):
                store(found, to + at, present * load(R, register + at, lane))


@njit(cache=True, fastmath=True, error_model="numpy")
def subtract_forces(tables: Tables, program: int, factor: Value, out: np.ndarray, lane: LaneTuple) -> None:
    """Subtract a factor times forces at sites, rows 0 and 1 found by a program, from nodal ones [nodes, 2, lanes]."""
    heads, _, _, _, _, numbers, reals, _, found, _ = tables
    head, lanes = heads[program], len(lane)
    points, per, nodes = head[POINTS], head[PER], numbers[head[NUMBERS] :]
    weights, here = head[REALS] + 2 * points * per, head[FOUND]
    for s in range(points):
        x = factor * load(found, here + s * lanes, lane)
        y = factor * load(found, here + (points + s) * lanes, lane)
        for k in range(s * per, (s + 1) * per):
            weight, at = -reals[weights + k], 2 * nodes[k] * lanes
            add(out, at, weight * x)
            add(out, at + lanes, weight * y)


@njit(cache=True, fastmath=True, error_model="numpy")
def add_stresses(tables: Tables, program: int, place: np.ndarray, out: np.ndarray, lane: LaneTuple) -> None:
    """Add stresses, rows 0 to 3, to those of the elements in their places, [n, points, 4, lanes]."""
    heads, _, _, _, outputs, numbers, _, _, found, _ = tables
    head, lanes = heads[program], len(lane)
    points, per, elements = head[POINTS], head[PER], numbers[head[NUMBERS] :]
    for n in range(head[OUTPUTS], head[OUTPUTS_END]):
        row, i, of = outputs[n, 0], outputs[n, 2], outputs[n, 3]
        if of >= 0:
            continue
        here = head[FOUND] + row * points * lanes
        for e in range(points // per):
            for g in range(per):
                at = 4 * (place[elements[e]] * per + g) + i
                add(out, at * lanes, load(found, here + (e * per + g) * lanes, lane))


@njit(cache=True, fastmath=True, error_model="numpy")
def add_slopes(
    tables: Tables,
    program: int,
    first: int,
    place: np.ndarray,
    weights: np.ndarray,
    site_matrices: tuple[np.ndarray, np.ndarray],
    stress_matrix: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Add the derivatives by the end-of-step acceleration, which moves position, velocity and acceleration by weights
    [3, lanes]: less those of forces at sites, from number `first` on, by the value and by the tangent there
    [sites, 2, 2, lanes]; those of stresses [n, points, 4, 4, lanes].
    """
    heads, _, _, _, outputs, numbers, _, _, found, _ = tables
    by_value, by_tangent = site_matrices
    head, lanes = heads[program], len(lane)
    points, per, elements = head[POINTS], head[PER], numbers[head[NUMBERS] :]
    for n in range(head[OUTPUTS], head[OUTPUTS_END]):
        row, i, of, j = outputs[n, 0], outputs[n, 2], outputs[n, 3], outputs[n, 4]
        if of < 0:
            continue
        here = head[FOUND] + row * points * lanes
        derivative = of if of < TANGENT else of - TANGENT if of < DEFORMATION else of - DEFORMATION
        weight = load(weights, derivative * lanes, lane)
        less = 0.0 - weight
        if of < DEFORMATION:
            matrices = by_value if of < TANGENT else by_tangent
            for s in range(points):
                at = (4 * (first + s) + 2 * i + j) * lanes
                add(matrices, at, less * load(found, here + s * lanes, lane))
        else:
            for e in range(points // per):
                for g in range(per):
                    at = 16 * (place[elements[e]] * per + g) + 4 * i + j
                    add(stress_matrix, at * lanes, weight * load(found, here + (e * per + g) * lanes, lane))


@njit(cache=True, error_model="numpy")
def respond(
    tables: Tables,
    laws: np.ndarray,
    with_slopes: bool,
    motion: Fields,
    mesh: Places,
    signals: np.ndarray,
    weights: np.ndarray,
    terms: Terms,
    lane: LaneTuple,
) -> None:
    """What all laws add to a step; with their derivatives where wanted, weighted as in `add_slopes`.

    laws [n, 3]: of every law the program of its value, that of its response, and its first site, or -1 for a stress;
    terms: see `system.LawTable`.
    """
    forces, (_, by_value, by_tangent), (place, stress, matrix) = terms
    one = zero(lane) + 1.0
    forces[:] = 0.0
    stress[:] = 0.0
    if with_slopes:
        by_value[:] = 0.0
        by_tangent[:] = 0.0
        matrix[:] = 0.0
    for n in range(laws.shape[0]):
        program, first = laws[n, 1] if with_slopes else laws[n, 0], laws[n, 2]
        evaluate(tables, program, motion, mesh, signals, lane)
        if first >= 0:
            subtract_forces(tables, program, one, forces, lane)
        else:
            add_stresses(tables, program, place, stress, lane)
        if with_slopes:
            add_slopes(tables, program, first, place, weights, (by_value, by_tangent), matrix, lane)


@njit(inline="always")
def _interpolate_column(
    field: np.ndarray,
    column: int,
    head: np.ndarray,
    tables: Tables,
    weights: int,
    site: int,
    out: np.ndarray,
    to: int,
    lane: LaneTuple,
) -> None:
    """Write the components of a nodal field [columns, nodes, 2, lanes] at a site."""
    numbers, reals, per = tables[5], tables[6], head[PER]
    lanes, x, y = len(lane), zero(lane), zero(lane)
    for k in range(site * per, (site + 1) * per):
        at = 2 * (column * field.shape[1] + numbers[head[NUMBERS] + k]) * lanes
        x = x + reals[weights + k] * load(field, at, lane)
        y = y + reals[weights + k] * load(field, at + lanes, lane)
    store(out, 2 * to * lanes, x)
    store(out, (2 * to + 1) * lanes, y)


@njit(cache=True, fastmath=True, error_model="numpy")
def _subtract_direction(
    tables: Tables,
    program: int,
    looks: np.ndarray,
    fields: tuple[np.ndarray, np.ndarray],
    column: int,
    height: int,
    out: np.ndarray,
    lane: LaneTuple,
) -> None:
    heads, _, _, _, outputs, numbers, reals, _, found, _ = tables
    head, lanes, (rate, acceleration) = heads[program], len(lane), fields
    points, per, first = head[POINTS], head[PER], head[REALS]
    moved = np.empty(2 * (TANGENT_RATE + 1) * lanes)
    for s in range(points):
        if looks[VELOCITY]:
            _interpolate_column(rate, column, head, tables, first, s, moved, VELOCITY, lane)
        if looks[ACCELERATION]:
            _interpolate_column(acceleration, column, head, tables, first, s, moved, ACCELERATION, lane)
        if looks[TANGENT_RATE]:
            slope = first + points * per
            _interpolate_column(rate, column, head, tables, slope, s, moved, TANGENT_RATE, lane)
        x, y = zero(lane), zero(lane)
        for n in range(head[OUTPUTS], head[OUTPUTS_END]):
            row, i, of, j = outputs[n, 0], outputs[n, 2], outputs[n, 3], outputs[n, 4]
            if of >= 0 and looks[of]:
                slope = load(found, head[FOUND] + (row * points + s) * lanes, lane)
                change = slope * load(moved, (2 * of + j) * lanes, lane)
                if i == 0:
                    x = x - change
                else:
                    y = y - change
        weights = first + 2 * points * per
        for k in range(s * per, (s + 1) * per):
            at = 2 * (column * height + numbers[head[NUMBERS] + k]) * lanes
            add(out, at, reals[weights + k] * x)
            add(out, at + lanes, reals[weights + k] * y)


@njit(cache=True, error_model="numpy")
def subtract_directions(
    tables: Tables,
    laws: np.ndarray,
    rate: np.ndarray,
    acceleration: np.ndarray,
    out: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Subtract what the forces at sites change along velocities and accelerations [columns, nodes, 2, lanes] from
    columns of at least as many nodes; `respond` has found their derivatives.
    """
    heads, outputs = tables[0], tables[4]
    looks = np.zeros(RATE + 1, dtype=np.bool_)
    for n in range(laws.shape[0]):
        if laws[n, 2] < 0:
            continue
        head, program = heads[laws[n, 1]], laws[n, 1]
        looks[:] = False
        for o in range(head[OUTPUTS], head[OUTPUTS_END]):
            of = outputs[o, 3]
            if of in (VELOCITY, TANGENT_RATE, ACCELERATION):
                looks[of] = True
        if looks.any():
            for c in range(rate.shape[0]):
                _subtract_direction(tables, program, looks, (rate, acceleration), c, out.shape[1], out, lane)
