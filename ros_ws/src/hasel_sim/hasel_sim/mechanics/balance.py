# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Forces out of balance and their matrix, in one compiled pass over the elements.

What `constitutive` and `assembly` do in one loop per quantity, with the same laws, coefficients, sources and shapes;
nothing but nodal forces, the band and the stress leaves the pass. Derivatives of the first Piola stress at a Gauss
point are rows of four by F00, F01, F10, F11.
"""

import numpy as np
from numba import njit

from hasel_sim.mechanics.assembly import add_stress, add_to_nodes
from hasel_sim.mechanics.constitutive import COEFFICIENTS, thickness
from hasel_sim.mechanics.state import Fields
from hasel_sim.simd import (
    Four,
    LaneTuple,
    Value,
    add,
    four,
    load,
    logarithm_near_one,
    square_root,
    store,
    three,
    zero,
)

SolidOfLoops = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, bool]
DriveOfLoops = tuple[np.ndarray, np.ndarray, np.ndarray]
Further = tuple[np.ndarray, np.ndarray, np.ndarray]
"""`solid`, `drive` and `added` of `balance`."""
Body = tuple[SolidOfLoops, np.ndarray, np.ndarray]
"""`body` of the compiled loops, see `time_loop`."""
_Rows = tuple[Four, Four, Four, Four]


@njit(inline="always")
def _along(
    own: Value, f: tuple[Value, Value], trace: Four, rest: Four, turned: tuple[Value, Value], lane: LaneTuple
) -> Four:
    """Row of `viscous_rows` for a component of the stress in column 0.

    own: that component of F, f: its row of F; trace, rest: F and its rate weighted with Lamé's parameter and with the
    shear modulus, whose parts of the second Piola stress they are; turned: what F makes of the latter.
    """
    return (
        own * trace[0] + f[0] * rest[0] + turned[0],
        own * trace[1] + f[1] * rest[0],
        own * trace[2] + f[0] * rest[2] + turned[1],
        own * trace[3] + f[1] * rest[2],
    )


@njit(inline="always")
def _across(
    own: Value, f: tuple[Value, Value], trace: Four, rest: Four, turned: tuple[Value, Value], lane: LaneTuple
) -> Four:
    """The same for a component in column 1."""
    return (
        own * trace[0] + f[0] * rest[1],
        own * trace[1] + f[1] * rest[1] + turned[0],
        own * trace[2] + f[0] * rest[3],
        own * trace[3] + f[1] * rest[3] + turned[1],
    )


@njit(inline="always")
def viscous_rows(
    F: Four, rate: Four, by_F: tuple[Value, Value], by_rate: tuple[Value, Value], lane: LaneTuple
) -> _Rows:
    """Of F (lambda tr(E') I + 2 mu E') with the second Piola stress held.

    by_F, by_rate: (lambda, mu) of E' = F^T dF and of E' = (dF/dt)^T dF, made symmetric.
    """
    a, b, c, d = F
    ra, rb, rc, rd = rate
    lam, mu = by_F
    lam_rate, mu_rate = by_rate
    trace = lam * a + lam_rate * ra, lam * b + lam_rate * rb, lam * c + lam_rate * rc, lam * d + lam_rate * rd
    rest = mu * a + mu_rate * ra, mu * b + mu_rate * rb, mu * c + mu_rate * rc, mu * d + mu_rate * rd
    upper = a * rest[0] + b * rest[1], a * rest[2] + b * rest[3]
    lower = c * rest[0] + d * rest[1], c * rest[2] + d * rest[3]
    return (
        _along(a, (a, b), trace, rest, upper, lane),
        _across(b, (a, b), trace, rest, upper, lane),
        _along(c, (c, d), trace, rest, lower, lane),
        _across(d, (c, d), trace, rest, lower, lane),
    )


@njit(inline="always")
def add_elastic_rows(
    rows: _Rows,
    F: Four,
    inverse: Value,
    bulk: Value,
    pull: Value,
    held: tuple[Value, Value, Value],
    slope: Value,
    lane: LaneTuple,
) -> _Rows:
    """Add those of the neo-Hookean solid, of the stress that is held and of the fibres, which are symmetric.

    inverse: 1 / J; bulk: derivative of lambda ln J by ln J; pull: mu - lambda ln J; held: second Piola stress and what
    else multiplies the unit tensor (xx, yy, xy); slope: of the fibres' tension over their stretch.
    """
    a, b, c, d = F
    xx, yy, xy = held
    v0, v1, v2, v3 = d * inverse, (0.0 - c) * inverse, (0.0 - b) * inverse, a * inverse
    both, v03, v12 = bulk + pull, v0 * v3, v1 * v2
    k00, k01 = both * v0 * v0 + xx + slope * a * a, both * v0 * v1 + xy
    k02, k03 = both * v0 * v2 + slope * a * c, bulk * v03 + pull * v12
    k11, k12, k13 = both * v1 * v1 + yy, bulk * v12 + pull * v03, both * v1 * v3
    k22, k23, k33 = both * v2 * v2 + xx + slope * c * c, both * v2 * v3 + xy, both * v3 * v3 + yy
    (m00, m01, m02, m03), (m10, m11, m12, m13), (m20, m21, m22, m23), (m30, m31, m32, m33) = rows
    return (
        (m00 + k00, m01 + k01, m02 + k02, m03 + k03),
        (m10 + k01, m11 + k11, m12 + k12, m13 + k13),
        (m20 + k02, m21 + k12, m22 + k22, m23 + k23),
        (m30 + k03, m31 + k13, m32 + k23, m33 + k33),
    )


@njit(cache=True, fastmath=True, error_model="numpy")
def balance(
    motion: Fields,
    solid: SolidOfLoops,
    drive: DriveOfLoops,
    added: Further,
    masses: np.ndarray,
    weights: np.ndarray,
    expected: np.ndarray,
    wanted: tuple[bool, bool],
    out: tuple[np.ndarray, np.ndarray, np.ndarray, int],
    lane: LaneTuple,
) -> None:
    """Add inertia and internal force to the residual; where wanted, their matrix to the band.

    motion: position, velocity, acceleration [nodes, 2, lanes]; solid: elements, gradients, areas, stretch, muscle of
    each element, whether in plane stress; drive: coefficients per element, contraction, history of the branches (see
    `constitutive.first_piola`); added: index of every element among those with further stress or -1 [elements], first
    Piola stress of these [n, points, 4, lanes] and its derivative by the gradient of the end-of-step acceleration
    [n, points, 4, 4, lanes]; weights [3, lanes] of stiffness, damping and mass; wanted: (the matrix, with the geometric
    stiffness of the second Piola stress `expected` [elements, points, 3, lanes] in place of the one found); out:
    residual [nodes, 2, lanes], second Piola stress found, band, its diagonal.
    """
    position, velocity, acceleration = motion
    elements, gradients, areas, stretch, muscle, plane_stress = solid
    table, contraction, history = drive
    fresh, guessed = wanted
    further, further_stress, further_matrix = added
    residual, stress, band, diagonal = out
    lanes, points, width = len(lane), areas.shape[1], band.shape[1]
    none = zero(lane)
    x, v, force = np.empty(16 * lanes), np.empty(16 * lanes), np.empty(16 * lanes)
    half = np.empty(64 * points * lanes)
    by_position, by_velocity, by_acceleration = three(weights, 0, lane)
    for e in range(elements.shape[0]):
        own = COEFFICIENTS * lanes * e
        mu, lam, muv, lamv = four(table, own, lane)
        mub, lamb, w = three(table, own + 4 * lanes, lane)
        rest = 1.0 - load(contraction, muscle[e] * lanes, lane)
        lam_f, lam_rate = by_velocity * lamv + by_position * lamb, by_position * lamv
        mu_f, mu_rate = by_velocity * muv + by_position * mub, by_position * muv
        for a in range(8):
            at, to = 2 * lanes * elements[e, a], 2 * lanes * a
            store(x, to, load(position, at, lane))
            store(x, to + lanes, load(position, at + lanes, lane))
            store(v, to, load(velocity, at, lane))
            store(v, to + lanes, load(velocity, at + lanes, lane))
            store(force, to, none)
            store(force, to + lanes, none)
        for b in range(8):
            at = 2 * lanes * elements[e, b]
            ax, ay = load(acceleration, at, lane), load(acceleration, at + lanes, lane)
            for a in range(8):
                mass = load(masses, (64 * e + 8 * b + a) * lanes, lane)
                add(force, 2 * a * lanes, mass * ax)
                add(force, (2 * a + 1) * lanes, mass * ay)
        for g in range(points):
            point = e * points + g
            along, area = load(stretch, point * lanes, lane), areas[e, g]
            a, b, c, d = none, none, none, none
            ra, rb, rc, rd = none, none, none, none
            for n in range(8):
                dx, dy = gradients[e, g, n, 0], gradients[e, g, n, 1]
                nx, ny = load(x, 2 * n * lanes, lane), load(x, (2 * n + 1) * lanes, lane)
                a, b, c, d = a + nx * dx, b + nx * dy, c + ny * dx, d + ny * dy
                nx, ny = load(v, 2 * n * lanes, lane), load(v, (2 * n + 1) * lanes, lane)
                ra, rb, rc, rd = ra + nx * dx, rb + nx * dy, rc + ny * dx, rd + ny * dy
            shrink = 1.0 / along
            a, c, ra, rc = a * shrink, c * shrink, ra * shrink, rc * shrink
            J = a * d - b * c
            inverse = 1.0 / J
            volume, bulk = J, lam
            if plane_stress:
                f = thickness(mu, lam, J, lane)
                volume, bulk = J * f, lam * 2.0 * mu * f * f / (2.0 * mu * f * f + lam)
            pull = mu - lam * logarithm_near_one(volume, lane)
            q = (0.0 - pull) * inverse
            exx, eyy, exy = a * ra + c * rc, b * rb + d * rd, 0.5 * (a * rb + b * ra + c * rd + d * rc)
            gxx, gyy = 0.5 * (a * a + c * c - 1.0), 0.5 * (b * b + d * d - 1.0)
            hxx, hyy, hxy = three(history, 3 * lanes * point, lane)
            trace = lamv * (exx + eyy) + lamb * (gxx + gyy)
            sxx = trace + 2.0 * (muv * exx + mub * gxx) + hxx
            syy = trace + 2.0 * (muv * eyy + mub * gyy) + hyy
            sxy = 2.0 * muv * exy + mub * (a * b + c * d) + hxy
            p0, p1 = mu * a + q * d + a * sxx + b * sxy, mu * b - q * c + a * sxy + b * syy
            p2, p3 = mu * c - q * b + c * sxx + d * sxy, mu * d + q * a + c * sxy + d * syy
            tension, slope = none, none
            if muscle[e] != 0:
                long = 1.0 / square_root(a * a + c * c)
                tension, slope = w * (1.0 - rest * long), w * rest * long * long * long
                p0, p2 = p0 + tension * a, p2 + tension * c
            if further[e] >= 0:
                s0, s1, s2, s3 = four(further_stress, 4 * lanes * (further[e] * points + g), lane)
                p0, p1, p2, p3 = p0 + s0, p1 + s1, p2 + s2, p3 + s3
            txx, tyy = (d * p0 - b * p2) * inverse, (a * p3 - c * p1) * inverse
            txy = 0.5 * (d * p1 - b * p3 + a * p2 - c * p0) * inverse
            at = 3 * lanes * point
            store(stress, at, txx)
            store(stress, at + lanes, tyy)
            store(stress, at + 2 * lanes, txy)
            wide = area * along
            add_stress(force, (p0, p1, p2, p3), gradients, e, g, area, wide, lane)
            if not fresh:
                continue
            kxx, kyy, kxy = txx, tyy, txy
            if guessed:
                kxx, kyy, kxy = three(expected, at, lane)
            kxx = by_position * (kxx - txx + mu + sxx + tension)
            kyy = by_position * (kyy - tyy + mu + syy)
            kxy = by_position * (kxy - txy + sxy)
            rows = viscous_rows((a, b, c, d), (ra, rb, rc, rd), (lam_f, mu_f), (lam_rate, mu_rate), lane)
            (m00, m01, m02, m03), (m10, m11, m12, m13), (m20, m21, m22, m23), (m30, m31, m32, m33) = (
                add_elastic_rows(
                    rows,
                    (a, b, c, d),
                    inverse,
                    by_position * bulk,
                    by_position * pull,
                    (kxx, kyy, kxy),
                    by_position * slope,
                    lane,
                )
            )
            if further[e] >= 0:
                to = 16 * lanes * (further[e] * points + g)
                s0, s1, s2, s3 = four(further_matrix, to, lane)
                m00, m01, m02, m03 = m00 + s0, m01 + s1, m02 + s2, m03 + s3
                s0, s1, s2, s3 = four(further_matrix, to + 4 * lanes, lane)
                m10, m11, m12, m13 = m10 + s0, m11 + s1, m12 + s2, m13 + s3
                s0, s1, s2, s3 = four(further_matrix, to + 8 * lanes, lane)
                m20, m21, m22, m23 = m20 + s0, m21 + s1, m22 + s2, m23 + s3
                s0, s1, s2, s3 = four(further_matrix, to + 12 * lanes, lane)
                m30, m31, m32, m33 = m30 + s0, m31 + s1, m32 + s2, m33 + s3
            narrow = area * shrink
            m00, m02, m20, m22 = narrow * m00, narrow * m02, narrow * m20, narrow * m22
            m01, m03, m21, m23 = area * m01, area * m03, area * m21, area * m23
            m10, m12, m30, m32 = area * m10, area * m12, area * m30, area * m32
            m11, m13, m31, m33 = wide * m11, wide * m13, wide * m31, wide * m33
            for n in range(8):
                dx, dy = gradients[e, g, n, 0], gradients[e, g, n, 1]
                to = 8 * (n * points + g) * lanes
                store(half, to, m00 * dx + m01 * dy)
                store(half, to + lanes, m10 * dx + m11 * dy)
                store(half, to + 2 * lanes, m20 * dx + m21 * dy)
                store(half, to + 3 * lanes, m30 * dx + m31 * dy)
                store(half, to + 4 * lanes, m02 * dx + m03 * dy)
                store(half, to + 5 * lanes, m12 * dx + m13 * dy)
                store(half, to + 6 * lanes, m22 * dx + m23 * dy)
                store(half, to + 7 * lanes, m32 * dx + m33 * dy)
        add_to_nodes(force, elements, e, 0, residual, lane)
        if not fresh:
            continue
        for b in range(8):
            for a in range(0, 8, 2):
                at = (64 * e + 8 * b + a) * lanes
                xx, zz = (
                    by_acceleration * load(masses, at, lane),
                    by_acceleration * load(masses, at + lanes, lane),
                )
                xy, yx, yy = none, none, xx
                zw, wz, ww = none, none, zz
                for g in range(points):
                    to = 8 * (b * points + g) * lanes
                    h0, h1, h2, h3 = four(half, to, lane)
                    i0, i1, i2, i3 = four(half, to + 4 * lanes, lane)
                    dx, dy = gradients[e, g, a, 0], gradients[e, g, a, 1]
                    xx, xy = xx + dx * h0 + dy * h1, xy + dx * i0 + dy * i1
                    yx, yy = yx + dx * h2 + dy * h3, yy + dx * i2 + dy * i3
                    dx, dy = gradients[e, g, a + 1, 0], gradients[e, g, a + 1, 1]
                    zz, zw = zz + dx * h0 + dy * h1, zw + dx * i0 + dy * i1
                    wz, ww = wz + dx * h2 + dy * h3, ww + dx * i2 + dy * i3
                line, to = (width - 1) * lanes, diagonal + 2 * elements[e, b]
                at = 2 * elements[e, a] * line + to * lanes
                add(band, at, xx)
                add(band, at + lanes, xy)
                add(band, at + line, yx)
                add(band, at + line + lanes, yy)
                at = 2 * elements[e, a + 1] * line + to * lanes
                add(band, at, zz)
                add(band, at + lanes, zw)
                add(band, at + line, wz)
                add(band, at + line + lanes, ww)
