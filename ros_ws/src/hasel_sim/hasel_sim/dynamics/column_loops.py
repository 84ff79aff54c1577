# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Compiled loops for what parameters change at a fixed motion, see `parameter_columns`.

The tuples that the functions share:
`columns`: recorded laws as in `tape_loops`; laws differentiated by a parameter; laws by the contraction; further
stress; bodies; room.
laws: (program, column, whether a force at sites) [n, 3]; their factors [n, 1 + muscles, lanes], all muscles alike.
laws by the contraction: (program, muscle, whether a force at sites) [n, 3]; a stress knows its own muscle's only.
further stress: place of every element among those that have one or -1; room for it [n, points, 4, lanes] and for its
derivative, which is not used.
bodies: those of central differences, first axis of all arrays: column, programs (first and last) and whether only the
stress differs [bodies, 4]; these programs, and whether each is a force at sites [n, 2]; factor in the difference;
gradients, areas and stretch of the stress-free shape; coefficients for every kind of step; masses; weight; what the
branches keep and gain to the balance and to the end of every kind of step, and moduli of C : E.
room: nodal forces, stress, history, and a band that nobody writes to.
"""

import numpy as np
from numba import njit

from hasel_sim.laws.tape_loops import Tables, add_stresses, evaluate, subtract_forces
from hasel_sim.mechanics.assembly import add_stress, add_to_nodes, scatter_stress
from hasel_sim.mechanics.balance import Further, SolidOfLoops, balance
from hasel_sim.mechanics.branches import add_parameter, carried
from hasel_sim.mechanics.constitutive import deformation, first_piola, green_stress
from hasel_sim.mechanics.state import Fields
from hasel_sim.simd import LaneTuple, add, four, load, store, zero

MemoryOfLoops = tuple[
    np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, tuple[np.ndarray, np.ndarray]
]
"""`memory` of the time loop."""
_Start = MemoryOfLoops | tuple[np.ndarray, np.ndarray]
"""Its first two alone, in statics."""
Bodies = tuple[
    np.ndarray,
    np.ndarray,
    np.ndarray,
    tuple[np.ndarray, ...],
    np.ndarray,
    np.ndarray,
    np.ndarray,
    tuple[np.ndarray, ...],
]
Columns = tuple[
    Tables,
    tuple[np.ndarray, np.ndarray],
    np.ndarray,
    Further,
    Bodies,
    tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray],
]
"""`columns` of the loops."""


@njit(cache=True, fastmath=True, error_model="numpy")
def add_further_forces(
    place: np.ndarray,
    stress: np.ndarray,
    factors: np.ndarray,
    solid: SolidOfLoops,
    out: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Add the nodal forces of a further stress times a factor of each element's muscle [1 + muscles, lanes]."""
    elements, gradients, areas, stretch, muscle, _ = solid
    lanes, points = len(lane), areas.shape[1]
    local = np.empty(16 * lanes)
    for e in range(elements.shape[0]):
        if place[e] < 0:
            continue
        local[:] = 0.0
        factor = load(factors, muscle[e] * lanes, lane)
        for g in range(points):
            p0, p1, p2, p3 = four(stress, 4 * (place[e] * points + g) * lanes, lane)
            P = factor * p0, factor * p1, factor * p2, factor * p3
            area = areas[e, g]
            wide = area * load(stretch, (e * points + g) * lanes, lane)
            add_stress(local, P, gradients, e, g, area, wide, lane)
        add_to_nodes(local, elements, e, 0, out, lane)


@njit(inline="always")
def _differentiated_laws(
    columns: Columns,
    motion: Fields,
    solid: SolidOfLoops,
    signals: np.ndarray,
    loads: float,
    out: np.ndarray,
    lane: LaneTuple,
) -> None:
    tables, (laws, factors), _, (place, stress, _), _, _ = columns
    lanes = len(lane)
    for n in range(laws.shape[0]):
        program, column = laws[n, 0], laws[n, 1]
        evaluate(tables, program, motion, solid[:4], signals, lane)
        if laws[n, 2]:
            factor = loads * load(factors, n * factors.shape[1] * lanes, lane)
            subtract_forces(tables, program, factor, out[column], lane)
        else:
            stress[:] = 0.0
            add_stresses(tables, program, place, stress, lane)
            add_further_forces(place, stress, factors[n], solid, out[column], lane)


@njit(inline="always")
def _differences(
    columns: Columns,
    kind: int,
    motion: Fields,
    solid: SolidOfLoops,
    signals: np.ndarray,
    memory: _Start,
    loads: float,
    out: np.ndarray,
    lane: LaneTuple,
) -> None:
    tables, _, _, further, bodies, (vector, found, history, band) = columns
    which, programs, factors, (gradients, areas, stretch), coefficients, masses, weight, branches = bodies
    elements, _, _, _, muscle, plane_stress = solid
    place, stress, _ = further
    lanes, one = len(lane), zero(lane) + 1.0
    for b in range(which.shape[0]):
        if which[b, 3]:
            continue
        vector[:] = 0.0
        stress[:] = 0.0
        own = elements, gradients[b], areas[b], stretch[b]
        for n in range(which[b, 1], which[b, 2]):
            evaluate(tables, programs[n, 0], motion, own, signals, lane)
            if programs[n, 1]:
                subtract_forces(tables, programs[n, 0], one, vector, lane)
            else:
                add_stresses(tables, programs[n, 0], place, stress, lane)
        for at in range(0, vector.size, lanes):
            store(vector, at, loads * (load(vector, at, lane) - load(weight[b], at, lane)))
        carried(branches[0][b, kind], branches[1][b, kind], memory[0], memory[1], history, lane)
        body, residual = (*own, muscle, plane_stress), (vector, found, band, 0)
        drive, unwanted = (coefficients[b, kind], signals, history), (np.bool_(False), np.bool_(False))
        weights = factors[b]  # of the matrix, which is not wanted
        balance(motion, body, drive, further, masses[b], weights, found, unwanted, residual, lane)
        factor, nodes = load(factors, 3 * b * lanes, lane), out[which[b, 0]]
        for at in range(0, vector.size, lanes):
            add(nodes, at, factor * load(vector, at, lane))


@njit(inline="always")
def _stress_differences(
    columns: Columns,
    kind: int,
    motion: Fields,
    solid: SolidOfLoops,
    signals: np.ndarray,
    memory: _Start,
    out: np.ndarray,
    lane: LaneTuple,
) -> None:
    _, _, _, _, (which, _, factors, _, coefficients, _, _, branches), (_, _, history, _) = columns
    elements, gradients, areas, stretch, muscle, plane_stress = solid
    count = which.shape[0] if which[:, 3].any() else 0
    lanes, shape = len(lane), (areas.shape[0] if count else 0, areas.shape[1], 4, len(lane))
    F, rate, P, total = np.empty(shape), np.empty(shape), np.empty(shape), np.zeros(shape)
    if count:
        deformation(motion[0], elements, gradients, stretch, F, lane)
        deformation(motion[1], elements, gradients, stretch, rate, lane)
    for b in range(count):
        if not which[b, 3]:
            continue
        carried(branches[0][b, kind], branches[1][b, kind], memory[0], memory[1], history, lane)
        first_piola(F, rate, coefficients[b, kind], muscle, signals, history, plane_stress, P, lane)
        factor = load(factors, 3 * b * lanes, lane)
        for at in range(0, P.size, lanes):
            add(total, at, factor * load(P, at, lane))
        if b + 1 == which.shape[0] or which[b + 1, 0] != which[b, 0]:
            scatter_stress(total, elements, gradients, areas, stretch, out[which[b, 0]], lane)
            total[:] = 0.0


@njit(cache=True, fastmath=True, error_model="numpy")
def add_residual_columns(
    columns: Columns,
    kind: int,
    motion: Fields,
    solid: SolidOfLoops,
    signals: np.ndarray,
    memory: _Start,
    loads: float,
    out: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Add what every parameter changes in the residual to its column of out [columns, nodes or more, 2, lanes].

    kind: of the step; motion, solid, signals: as in `balance`; memory: stresses of the branches and C : E where the
    step starts; loads: the share of all loads.
    """
    _differentiated_laws(columns, motion, solid, signals, loads, out, lane)
    _stress_differences(columns, kind, motion, solid, signals, memory, out, lane)
    _differences(columns, kind, motion, solid, signals, memory, loads, out, lane)


@njit(cache=True, error_model="numpy")
def add_laws_by_contraction(
    columns: Columns,
    motion: Fields,
    solid: SolidOfLoops,
    signals: np.ndarray,
    by_contraction: np.ndarray,
    out: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Add what laws change with the contraction, by_contraction [columns, 1 + muscles, lanes], to the columns."""
    tables, _, laws, (place, stress, _), _, _ = columns
    if laws.shape[0] == 0 or not by_contraction.any():
        return
    lanes, muscles, stresses = len(lane), by_contraction.shape[1], False
    stress[:] = 0.0
    for n in range(laws.shape[0]):
        program = laws[n, 0]
        evaluate(tables, program, motion, solid[:4], signals, lane)
        if not laws[n, 2]:
            add_stresses(tables, program, place, stress, lane)
            stresses = True
            continue
        for c in range(out.shape[0]):
            factor = load(by_contraction, (c * muscles + laws[n, 1]) * lanes, lane)
            subtract_forces(tables, program, factor, out[c], lane)
    if stresses:
        for c in range(out.shape[0]):
            add_further_forces(place, stress, by_contraction[c], solid, out[c], lane)


@njit(cache=True, error_model="numpy")
def add_branch_columns(
    columns: Columns,
    kind: int,
    position: np.ndarray,
    elements: np.ndarray,
    F: np.ndarray,
    memory: _Start,
    branch: np.ndarray,
    green: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Add what parameters change in the branches' stresses and in C : E at the end of a step, at its position.

    F: deformation there [elements, points, 4, lanes], that of the bodies of which only the stress differs.
    """
    which, _, factors, (gradients, _, stretch), _, _, _, branches = columns[4]
    _, _, left, gain, shear, lame = branches
    other, own = np.empty_like(F), np.empty((*F.shape[:2], 3, len(lane)))
    for b in range(which.shape[0]):
        if which[b, 3]:
            green_stress(F, shear[b], lame[b], own, lane)
        else:
            deformation(position, elements, gradients[b], stretch[b], other, lane)
            green_stress(other, shear[b], lame[b], own, lane)
        column, factor, start, start_green = which[b, 0], factors[b, 0], memory[0], memory[1]
        ends = branch[column], green[column]
        add_parameter(left[b, kind], gain[b, kind], start, start_green, own, factor, ends[0], ends[1], lane)
