"""Compiled loops over the stresses of internal branches and over their derivatives, see `branches`.

Stresses [branches, elements, points, 3, lanes], C : E [elements, points, 3, lanes]; derivatives have the columns first.
What a step leaves and adds: left, gain [branches, lanes].
"""

import numpy as np
from numba import njit

from hasel_sim.mechanics.strain import deformation, green_stress_direction
from hasel_sim.simd import load, store, zero


@njit(cache=True, fastmath=True, error_model="numpy")
def carried(left, gain, stresses, green, out, lane):
    """The part of the branches' stress after a step that no new strain changes, [elements, points, 3, lanes]."""
    lanes = len(lane)
    for at in range(0, out.size, lanes):
        total = zero(lane)
        for b in range(stresses.shape[0]):
            total = total + load(left, b * lanes, lane) * load(stresses, b * out.size + at, lane)
            total = total - load(gain, b * lanes, lane) * load(green, at, lane)
        store(out, at, total)


@njit(cache=True, fastmath=True, error_model="numpy")
def history(left, gain, stresses, green, out, lane):
    """Derivatives of what the branches carry over a step, [columns, elements, points, 3, lanes]."""
    for c in range(green.shape[0]):
        carried(left, gain, stresses[c], green[c], out[c], lane)


@njit(cache=True, fastmath=True, error_model="numpy")
def green_along(moved, F, places, shear, lame, out, lane):
    """Derivatives of C : E along those of the positions, moved [columns, nodes, 2, lanes], at a deformation F."""
    elements, gradients, _, stretch = places
    change = np.empty_like(F)
    for c in range(moved.shape[0]):
        deformation(moved[c], elements, gradients, stretch, change, lane)
        green_stress_direction(F, change, shear, lame, out[c], lane)


@njit(cache=True, fastmath=True, error_model="numpy")
def advance(left, gain, stresses, green, new_green, out, lane):
    """Derivatives of the branches' stresses at the end of a step, where those of C : E are `new_green`."""
    lanes, branches = len(lane), stresses.shape[1]
    size = green.shape[1] * green.shape[2] * green.shape[3] * lanes
    for c in range(green.shape[0]):
        for at in range(0, size, lanes):
            more = load(new_green, c * size + at, lane) - load(green, c * size + at, lane)
            for b in range(branches):
                place = (c * branches + b) * size + at
                old = load(left, b * lanes, lane) * load(stresses, place, lane)
                store(out, place, old + load(gain, b * lanes, lane) * more)


@njit(cache=True, fastmath=True, error_model="numpy")
def add_parameter(left, gain, stresses, green, own, factor, more, more_green, lane):
    """Add to the derivatives `more` and `more_green` of one column a factor [lanes] times what the branches and C : E
    of one body are at the end of a step: stresses and green at its beginning, own C : E at its end.
    """
    lanes, branches, size = len(lane), stresses.shape[0], green.size
    times = load(factor, 0, lane)
    for at in range(0, size, lanes):
        new = load(own, at, lane)
        change = new - load(green, at, lane)
        store(more_green, at, load(more_green, at, lane) + times * new)
        for b in range(branches):
            place = b * size + at
            end = (
                load(left, b * lanes, lane) * load(stresses, place, lane)
                + load(gain, b * lanes, lane) * change
            )
            store(more, place, load(more, place, lane) + times * end)
