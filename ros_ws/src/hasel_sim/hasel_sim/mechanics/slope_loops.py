"""Compiled loops for the derivatives of a step: the system that they solve, and what its solution means.

With A the matrix of the step and s the change of the positions at the balance that the derivatives before the step
bring: A (s / c), c being the weight of the end-of-step acceleration in these positions, stands for the stiffness, so
that only damping, inertia and what a parameter changes at a fixed motion are left on the right-hand side.
"""

import numpy as np
from numba import njit

from hasel_sim.mechanics.constitutive import COEFFICIENTS
from hasel_sim.mechanics.element_force import add_stress, add_to_nodes, product
from hasel_sim.mechanics.lane_loops import chosen_of
from hasel_sim.simd import add, four, load, square_root, store, three, zero


@njit(cache=True, fastmath=True, error_model="numpy")
def directions(slopes, weights, out, lane):
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
def right_hand_sides(position, body, drive, moved, by_contraction, stress, further, out, lane):
    """Add to out [columns, nodes or more, 2, lanes] what damping, inertia, contraction and further stress change.

    position: at the balance; body, drive: as in `march` and `balance`; moved: changes of velocity and acceleration
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
def advance(slopes, instead, solution, to_end, chosen, lane):
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
