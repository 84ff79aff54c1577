"""Compiled loops over elements and Gauss points: internal force, moduli, banded assembly, directional derivatives.

Every array has the lanes as its last axis (see `simd.py`) but those that describe the mesh: elements, gradients and
areas. Indices of a deformation gradient run 00, 01, 10, 11 (row-major). `stretch` is that of the stress-free shape
along the body: gradients by x shrink with it, areas grow. Coefficients per element, in this order: shear modulus and
Lamé's first parameter of the neo-Hookean solid [Pa], the same two of the viscous stress [Pa s], the same two of the
elastic stress that internal branches add within a step [Pa], fibre stiffness [Pa].

Neo-Hookean, W = mu/2 (I1 - 2 - 2 ln J) + lambda/2 (ln J)^2: P = mu (F - F^-T) + lambda ln J F^-T (Bonet and Wood,
Nonlinear Continuum Mechanics for Finite Element Analysis, section 6.4). Kelvin-Voigt:
S = lambda_v tr(dE/dt) I + 2 mu_v dE/dt. Fibre along x: 1/2 w (|F m| - (1 - a))^2.

A trial shape with an element of no area gives infinities, which end that trial, and no ZeroDivisionError.
"""

import numpy as np
from numba import njit

from hasel_sim.mechanics.element_force import add_stress, add_to_nodes, product
from hasel_sim.mechanics.simd import (
    add,
    four,
    load,
    logarithm,
    of_lane,
    square_root,
    store,
    three,
    with_lane,
    zero,
)

COEFFICIENTS = 7
SHEAR, LAME, VISCOUS_SHEAR, VISCOUS_LAME, BRANCH_SHEAR, BRANCH_LAME, FIBRE = range(COEFFICIENTS)


@njit(cache=True, fastmath=True, error_model="numpy")
def deformation(field, elements, gradients, stretch, out, lane):
    """Gradient of a nodal field [nodes, 2, lanes] at every Gauss point, into out [elements, points, 4, lanes]."""
    lanes, points = len(lane), gradients.shape[1]
    for e in range(elements.shape[0]):
        for g in range(points):
            point = e * points + g
            f00, f01, f10, f11 = zero(lane), zero(lane), zero(lane), zero(lane)
            for a in range(8):
                at = 2 * lanes * elements[e, a]
                x, y = load(field, at, lane), load(field, at + lanes, lane)
                dx, dy = gradients[e, g, a, 0], gradients[e, g, a, 1]
                f00, f01, f10, f11 = f00 + x * dx, f01 + x * dy, f10 + y * dx, f11 + y * dy
            along, at = load(stretch, point * lanes, lane), 4 * lanes * point
            store(out, at, f00 / along)
            store(out, at + lanes, f01)
            store(out, at + 2 * lanes, f10 / along)
            store(out, at + 3 * lanes, f11)


@njit(cache=True, fastmath=True, error_model="numpy")
def through_thickness_stretch(shear, lame, area_ratio):
    """Stretch f with no stress through the thickness: mu (f^2 - 1) + lambda ln(area_ratio f) = 0 (Newton)."""
    f = area_ratio ** (-lame / (lame + 2.0 * shear))
    for _ in range(50):
        step = (shear * (f * f - 1.0) + lame * np.log(area_ratio * f)) / (2.0 * shear * f + lame / f)
        f -= step
        if abs(step) < 1e-15:
            break
    return f


@njit(inline="always")
def _thickness(shear, lame, area_ratio, lane):
    """The same in every lane."""
    out = zero(lane)
    for n in range(len(lane)):
        out = with_lane(
            out, n, through_thickness_stretch(of_lane(shear, n), of_lane(lame, n), of_lane(area_ratio, n))
        )
    return out


@njit(cache=True, fastmath=True, error_model="numpy")
def first_piola(F, rate, coefficients, muscle, contraction, history, plane_stress, P, lane):
    """First Piola stress [Pa] at every Gauss point.

    F, rate: deformation gradient and its rate, P: result, all [elements, points, 4, lanes]; contraction:
    [1 + muscles, lanes] with 0 first; history: second Piola stress of the internal branches from earlier steps
    [elements, points, 3, lanes] (xx, yy, xy).
    """
    lanes, points = len(lane), F.shape[1]
    for e in range(F.shape[0]):
        own = COEFFICIENTS * lanes * e
        mu, lam, muv, lamv = four(coefficients, own, lane)
        mub, lamb, w = three(coefficients, own + 4 * lanes, lane)
        rest = 1.0 - load(contraction, muscle[e] * lanes, lane)
        for g in range(points):
            at = 4 * lanes * (e * points + g)
            a, b, c, d = four(F, at, lane)
            ra, rb, rc, rd = four(rate, at, lane)
            hxx, hyy, hxy = three(history, 3 * lanes * (e * points + g), lane)
            J = a * d - b * c
            volume = J
            if plane_stress:
                volume = J * _thickness(mu, lam, J, lane)
            q = (lam * logarithm(volume) - mu) / J
            exx, eyy, exy = a * ra + c * rc, b * rb + d * rd, 0.5 * (a * rb + b * ra + c * rd + d * rc)
            gxx, gyy = 0.5 * (a * a + c * c - 1.0), 0.5 * (b * b + d * d - 1.0)
            trace = lamv * (exx + eyy) + lamb * (gxx + gyy)
            sxx = trace + 2.0 * (muv * exx + mub * gxx) + hxx
            syy = trace + 2.0 * (muv * eyy + mub * gyy) + hyy
            sxy = 2.0 * muv * exy + mub * (a * b + c * d) + hxy
            p0 = mu * a + q * d + a * sxx + b * sxy
            p2 = mu * c - q * b + c * sxx + d * sxy
            if muscle[e] != 0:
                tension = w * (1.0 - rest / square_root(a * a + c * c))
                p0, p2 = p0 + tension * a, p2 + tension * c
            store(P, at, p0)
            store(P, at + lanes, mu * b - q * c + a * sxy + b * syy)
            store(P, at + 2 * lanes, p2)
            store(P, at + 3 * lanes, mu * d + q * a + c * sxy + d * syy)


@njit(cache=True, fastmath=True, error_model="numpy")
def moduli(F, rate, coefficients, muscle, contraction, history, plane_stress, elastic, viscous, lane):
    """Derivatives of the first Piola stress by F (elastic) and its rate (viscous), [elements, points, 4, 4, lanes]."""
    lanes, points = len(lane), F.shape[1]
    none = zero(lane)
    for e in range(F.shape[0]):
        own = COEFFICIENTS * lanes * e
        mu, lam, muv, lamv = four(coefficients, own, lane)
        mub, lamb, w = three(coefficients, own + 4 * lanes, lane)
        rest = 1.0 - load(contraction, muscle[e] * lanes, lane)
        for g in range(points):
            point = e * points + g
            at = 4 * lanes * point
            a, b, c, d = four(F, at, lane)
            ra, rb, rc, rd = four(rate, at, lane)
            S00, S11, S01 = three(history, 3 * lanes * point, lane)
            deform, speed = ((a, b), (c, d)), ((ra, rb), (rc, rd))
            J = a * d - b * c
            inverse = ((d / J, (0.0 - b) / J), ((0.0 - c) / J, a / J))
            log_volume, bulk = none, lam
            if plane_stress:
                f = _thickness(mu, lam, J, lane)
                log_volume, bulk = logarithm(J * f), lam * 2.0 * mu * f * f / (2.0 * mu * f * f + lam)
            else:
                log_volume = logarithm(J)
            exx, eyy, exy = a * ra + c * rc, b * rb + d * rd, 0.5 * (a * rb + b * ra + c * rd + d * rc)
            gxx, gyy = 0.5 * (a * a + c * c - 1.0), 0.5 * (b * b + d * d - 1.0)
            trace = lamv * (exx + eyy) + lamb * (gxx + gyy)
            S00 = S00 + trace + 2.0 * (muv * exx + mub * gxx)
            S11 = S11 + trace + 2.0 * (muv * eyy + mub * gyy)
            S01 = S01 + 2.0 * muv * exy + mub * (a * b + c * d)
            S = ((S00, S01), (S01, S11))
            pull = mu - lam * log_volume
            for k in range(2):
                for L in range(2):
                    # variation of F (and of its rate) by the unit tensor e_k (x) e_L
                    dxx, dyy, dxy = none, none, 0.5 * speed[k][1 - L]
                    hxx, hyy, hxy = none, none, 0.5 * deform[k][1 - L]
                    if L == 0:
                        dxx, hxx = speed[k][0], deform[k][0]
                    else:
                        dyy, hyy = speed[k][1], deform[k][1]
                    both = lamv * (dxx + dyy) + lamb * (hxx + hyy)
                    txx = both + 2.0 * (muv * dxx + mub * hxx)
                    tyy = both + 2.0 * (muv * dyy + mub * hyy)
                    txy = 2.0 * (muv * dxy + mub * hxy)
                    vxx = lamv * (hxx + hyy) + 2.0 * muv * hxx
                    vyy = lamv * (hxx + hyy) + 2.0 * muv * hyy
                    vxy = 2.0 * muv * hxy
                    for i in range(2):
                        fx, fy = deform[i][0], deform[i][1]
                        here = (16 * point + 8 * i + 2 * k + L) * lanes
                        store(viscous, here, fx * vxx + fy * vxy)
                        store(viscous, here + 4 * lanes, fx * vxy + fy * vyy)
                        for j in range(2):
                            value = (
                                pull * inverse[j][k] * inverse[L][i] + bulk * inverse[j][i] * inverse[L][k]
                            )
                            if i == k:
                                value = value + S[L][j]
                                if j == L:
                                    value = value + mu
                            if j == 0:
                                value = value + fx * txx + fy * txy
                            else:
                                value = value + fx * txy + fy * tyy
                            store(elastic, here + 4 * j * lanes, value)
            if muscle[e] != 0:
                stretch = square_root(a * a + c * c)
                tension = w * (1.0 - rest / stretch)
                slope = w * rest / (stretch * stretch * stretch)
                here = 16 * point * lanes
                add(elastic, here, tension + slope * a * a)
                add(elastic, here + 2 * lanes, slope * a * c)
                add(elastic, here + 8 * lanes, slope * a * c)
                add(elastic, here + 10 * lanes, tension + slope * c * c)


@njit(cache=True, fastmath=True, error_model="numpy")
def scatter_stress(P, elements, gradients, areas, stretch, force, lane):
    """Add the nodal forces of a stress field [elements, points, 4, lanes] to force [nodes, 2, lanes]."""
    lanes, points = len(lane), areas.shape[1]
    local = np.empty(16 * lanes)
    for e in range(elements.shape[0]):
        local[:] = 0.0
        for g in range(points):
            point = e * points + g
            area = areas[e, g]
            wide = area * load(stretch, point * lanes, lane)
            add_stress(local, four(P, 4 * lanes * point, lane), gradients, e, g, area, wide, lane)
        add_to_nodes(local, elements, e, 0, force, lane)


@njit(cache=True, fastmath=True, error_model="numpy")
def scatter_matrix(
    elastic, viscous, masses, weights, elements, gradients, areas, stretch, band, diagonal, lane
):
    """Add weights[0] K + weights[1] C + weights[2] M to a band matrix, entry (i, j) at [i, diagonal + j - i].

    elastic, viscous: moduli [elements, points, 4, 4, lanes]; masses: [elements, 8, 8, lanes]; weights: [3, lanes].
    """
    lanes, points, width = len(lane), areas.shape[1], band.shape[1]
    half = np.empty(64 * points * lanes)
    by_position, by_velocity, by_acceleration = three(weights, 0, lane)
    none = zero(lane)
    for e in range(elements.shape[0]):
        for g in range(points):
            point = e * points + g
            along = load(stretch, point * lanes, lane)
            for row in range(4):
                at = (16 * point + 4 * row) * lanes
                k0, k1, k2, k3 = four(elastic, at, lane)
                v0, v1, v2, v3 = four(viscous, at, lane)
                s = areas[e, g] / along if row % 2 == 0 else areas[e, g] + none
                m0, m1 = by_position * k0 + by_velocity * v0, along * (by_position * k1 + by_velocity * v1)
                m2, m3 = by_position * k2 + by_velocity * v2, along * (by_position * k3 + by_velocity * v3)
                m0, m1, m2, m3 = s * m0, s * m1, s * m2, s * m3
                for b in range(8):
                    dx, dy = gradients[e, g, b, 0], gradients[e, g, b, 1]
                    at = (2 * b * points + g) * 4 * lanes + row * lanes
                    store(half, at, m0 * dx + m1 * dy)
                    store(half, at + 4 * points * lanes, m2 * dx + m3 * dy)
        for column in range(16):
            b, j = column // 2, column % 2
            for a in range(0, 8, 2):
                at = (64 * e + 8 * a + b) * lanes
                x0, x1 = (
                    by_acceleration * load(masses, at, lane),
                    by_acceleration * load(masses, at + 8 * lanes, lane),
                )
                y0, y1 = none, none
                if j == 1:
                    x0, x1, y0, y1 = none, none, x0, x1
                for g in range(points):
                    h0, h1, h2, h3 = four(half, (column * points + g) * 4 * lanes, lane)
                    dx, dy = gradients[e, g, a, 0], gradients[e, g, a, 1]
                    x0, y0 = x0 + dx * h0 + dy * h1, y0 + dx * h2 + dy * h3
                    dx, dy = gradients[e, g, a + 1, 0], gradients[e, g, a + 1, 1]
                    x1, y1 = x1 + dx * h0 + dy * h1, y1 + dx * h2 + dy * h3
                row, to = 2 * elements[e, a], 2 * elements[e, b] + j
                at = (row * (width - 1) + diagonal + to) * lanes
                add(band, at, x0)
                add(band, at + (width - 1) * lanes, y0)
                row = 2 * elements[e, a + 1]
                at = (row * (width - 1) + diagonal + to) * lanes
                add(band, at, x1)
                add(band, at + (width - 1) * lanes, y1)


@njit(cache=True, fastmath=True, error_model="numpy")
def scatter_directions(moduli, stress, elements, gradients, areas, stretch, directions, force, lane):
    """Add to force [columns, nodes, 2, lanes] the change of the nodal forces along many directions at once.

    moduli: [elements, points, 4, 4, lanes], by F or by its rate; directions: of the nodal positions or velocities
    [columns, nodes, 2, lanes]; stress: change of the first Piola stress that does not come from them,
    [columns, elements, points, 4, lanes], or an empty first axis for none.
    """
    lanes, points, count = len(lane), areas.shape[1], elements.shape[0]
    nodes = directions.shape[1]
    local, here = np.empty(16 * lanes), np.empty(16 * lanes)
    for e in range(count):
        for column in range(directions.shape[0]):
            local[:] = 0.0
            for a in range(8):
                at = 2 * lanes * (column * nodes + elements[e, a])
                store(here, 2 * a * lanes, load(directions, at, lane))
                store(here, (2 * a + 1) * lanes, load(directions, at + lanes, lane))
            for g in range(points):
                point = e * points + g
                d0, d1, d2, d3 = zero(lane), zero(lane), zero(lane), zero(lane)
                for a in range(8):
                    dx, dy = gradients[e, g, a, 0], gradients[e, g, a, 1]
                    x, y = load(here, 2 * a * lanes, lane), load(here, (2 * a + 1) * lanes, lane)
                    d0, d1, d2, d3 = d0 + x * dx, d1 + x * dy, d2 + y * dx, d3 + y * dy
                along = load(stretch, point * lanes, lane)
                d0, d2 = d0 / along, d2 / along
                p0, p1, p2, p3 = product(moduli, 16 * point * lanes, (d0, d1, d2, d3), lane)
                if stress.shape[0] > 0:
                    s0, s1, s2, s3 = four(stress, 4 * lanes * (column * count * points + point), lane)
                    p0, p1, p2, p3 = p0 + s0, p1 + s1, p2 + s2, p3 + s3
                area = areas[e, g]
                add_stress(local, (p0, p1, p2, p3), gradients, e, g, area, area * along, lane)
            add_to_nodes(local, elements, e, column * nodes, force, lane)


@njit(cache=True, fastmath=True, error_model="numpy")
def transpose_moduli(moduli, out, lane):
    """Exchange the rows and columns of moduli [elements, points, 4, 4, lanes]."""
    lanes = len(lane)
    for point in range(moduli.shape[0] * moduli.shape[1]):
        for i in range(4):
            for j in range(4):
                store(
                    out,
                    (16 * point + 4 * i + j) * lanes,
                    load(moduli, (16 * point + 4 * j + i) * lanes, lane),
                )


@njit(cache=True, fastmath=True, error_model="numpy")
def contraction_force(F, coefficients, muscle, elements, gradients, areas, force, lane):
    """Derivative of the internal force by the contraction of each muscle, into force [muscles, nodes, 2, lanes]."""
    lanes, points, nodes = len(lane), areas.shape[1], force.shape[1]
    force[:] = 0.0
    for e in range(elements.shape[0]):
        if muscle[e] == 0:
            continue
        w = load(coefficients, (COEFFICIENTS * e + FIBRE) * lanes, lane)
        for g in range(points):
            at = 4 * lanes * (e * points + g)
            a, c = load(F, at, lane), load(F, at + 2 * lanes, lane)
            pull = areas[e, g] * w / square_root(a * a + c * c)
            for n in range(8):
                dx = gradients[e, g, n, 0]
                at = 2 * lanes * ((muscle[e] - 1) * nodes + elements[e, n])
                add(force, at, pull * a * dx)
                add(force, at + lanes, pull * c * dx)


@njit(cache=True, fastmath=True, error_model="numpy")
def mass_product(masses, elements, columns, out, lane):
    """Add to out [columns, nodes, 2, lanes] the element masses [elements, 8, 8, lanes] times the nodal vectors."""
    lanes, nodes = len(lane), columns.shape[1]
    for e in range(elements.shape[0]):
        for column in range(columns.shape[0]):
            for a in range(8):
                x, y = zero(lane), zero(lane)
                for b in range(8):
                    mass = load(masses, (64 * e + 8 * a + b) * lanes, lane)
                    at = 2 * lanes * (column * nodes + elements[e, b])
                    x, y = x + mass * load(columns, at, lane), y + mass * load(columns, at + lanes, lane)
                at = 2 * lanes * (column * nodes + elements[e, a])
                add(out, at, x)
                add(out, at + lanes, y)


@njit(cache=True, fastmath=True, error_model="numpy")
def scatter_sites(direct, along, nodes, shape, slope, weights, band, diagonal, lane):
    """Add site matrices [n, 2, 2, lanes], for values (direct) and tangents (along) of the field, to a band matrix."""
    lanes, width = len(lane), band.shape[1]
    for s in range(nodes.shape[0]):
        for i in range(2):
            at = (4 * s + 2 * i) * lanes
            d0, d1 = load(direct, at, lane), load(direct, at + lanes, lane)
            t0, t1 = load(along, at, lane), load(along, at + lanes, lane)
            for a in range(nodes.shape[1]):
                weight = weights[s, a]
                row = 2 * nodes[s, a] + i
                for b in range(nodes.shape[1]):
                    by_value, by_slope = weight * shape[s, b], weight * slope[s, b]
                    at = (row * width + diagonal + 2 * nodes[s, b] - row) * lanes
                    add(band, at, by_value * d0 + by_slope * t0)
                    add(band, at + lanes, by_value * d1 + by_slope * t1)


@njit(cache=True, fastmath=True, error_model="numpy")
def second_piola(F, P, S, lane):
    """Symmetric second Piola stress (xx, yy, xy) F^-1 P [elements, points, 3, lanes] of a first Piola stress."""
    lanes = len(lane)
    for point in range(F.shape[0] * F.shape[1]):
        a, b, c, d = four(F, 4 * point * lanes, lane)
        p0, p1, p2, p3 = four(P, 4 * point * lanes, lane)
        J, at = a * d - b * c, 3 * point * lanes
        store(S, at, (d * p0 - b * p2) / J)
        store(S, at + lanes, (a * p3 - c * p1) / J)
        store(S, at + 2 * lanes, 0.5 * (d * p1 - b * p3 + a * p2 - c * p0) / J)


@njit(cache=True, fastmath=True, error_model="numpy")
def green_stress(F, shear, lame, out, lane):
    """C : E (xx, yy, xy) of the Green strain at every Gauss point, into out [elements, points, 3, lanes]."""
    lanes, points = len(lane), F.shape[1]
    for e in range(F.shape[0]):
        mu, lam = load(shear, e * lanes, lane), load(lame, e * lanes, lane)
        for g in range(points):
            a, b, c, d = four(F, 4 * lanes * (e * points + g), lane)
            xx, yy = 0.5 * (a * a + c * c - 1.0), 0.5 * (b * b + d * d - 1.0)
            at = 3 * lanes * (e * points + g)
            store(out, at, lam * (xx + yy) + 2.0 * mu * xx)
            store(out, at + lanes, lam * (xx + yy) + 2.0 * mu * yy)
            store(out, at + 2 * lanes, mu * (a * b + c * d))


@njit(cache=True, fastmath=True, error_model="numpy")
def green_stress_direction(F, change, shear, lame, out, lane):
    """Change of C : E along a change of F [elements, points, 4, lanes], into out [elements, points, 3, lanes]."""
    lanes, points = len(lane), F.shape[1]
    for e in range(F.shape[0]):
        mu, lam = load(shear, e * lanes, lane), load(lame, e * lanes, lane)
        for g in range(points):
            a, b, c, d = four(F, 4 * lanes * (e * points + g), lane)
            p, q, r, s = four(change, 4 * lanes * (e * points + g), lane)
            xx, yy = a * p + c * r, b * q + d * s
            at = 3 * lanes * (e * points + g)
            store(out, at, lam * (xx + yy) + 2.0 * mu * xx)
            store(out, at + lanes, lam * (xx + yy) + 2.0 * mu * yy)
            store(out, at + 2 * lanes, mu * (a * q + b * p + c * s + d * r))


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


@njit(cache=True, fastmath=True, error_model="numpy")
def clear_band(band, reach, diagonal, lane):
    """Set to zero what lies within reach of the diagonal; the rest of a band matrix always is."""
    lanes, width, first = len(lane), band.shape[1], 0
    for row in range(band.shape[0]):
        left, right = 0, width
        if row < len(reach):
            while first + reach[first] < row:
                first += 1
            left, right = diagonal - (row - first) - 4, min(width, diagonal + reach[row] + 5)
        for at in range((row * width + left) * lanes, (row * width + right) * lanes, lanes):
            store(band, at, zero(lane))
