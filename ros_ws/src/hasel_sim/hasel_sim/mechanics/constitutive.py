# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Strain and stress of the solid and its muscles at every Gauss point, and their derivatives.

Every array has the lanes as its last axis (see `simd.py`) but those that describe the mesh: elements and gradients.
`stretch` is that of the stress-free shape along the body: gradients by x shrink with it. Indices of a deformation
gradient run 00, 01, 10, 11 (row-major). Coefficients per element, in this order: shear modulus and Lamé's first
parameter of the neo-Hookean solid [Pa], the same two of the viscous stress [Pa s], the same two of the elastic stress
that internal branches add within a step [Pa], fibre stiffness [Pa].

Neo-Hookean, W = mu/2 (I1 - 2 - 2 ln J) + lambda/2 (ln J)^2: P = mu (F - F^-T) + lambda ln J F^-T (Bonet and Wood,
Nonlinear Continuum Mechanics for Finite Element Analysis, section 6.4). Kelvin-Voigt:
S = lambda_v tr(dE/dt) I + 2 mu_v dE/dt. Fibre along x: 1/2 w (|F m| - (1 - a))^2.

A trial shape with an element of no area gives infinities, which end that trial, and no ZeroDivisionError.
"""

import numpy as np
from numba import njit

from hasel_sim.simd import (
    LaneTuple,
    Value,
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


@njit(cache=True, fastmath=True, error_model="numpy")
def deformation(
    field: np.ndarray,
    elements: np.ndarray,
    gradients: np.ndarray,
    stretch: np.ndarray,
    out: np.ndarray,
    lane: LaneTuple,
) -> None:
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
def green_stress(
    F: np.ndarray, shear: np.ndarray, lame: np.ndarray, out: np.ndarray, lane: LaneTuple
) -> None:
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
def green_stress_direction(
    F: np.ndarray, change: np.ndarray, shear: np.ndarray, lame: np.ndarray, out: np.ndarray, lane: LaneTuple
) -> None:
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
def second_piola(F: np.ndarray, P: np.ndarray, S: np.ndarray, lane: LaneTuple) -> None:
    """Symmetric second Piola stress (xx, yy, xy) F^-1 P [elements, points, 3, lanes] of a first Piola stress."""
    lanes = len(lane)
    for point in range(F.shape[0] * F.shape[1]):
        a, b, c, d = four(F, 4 * point * lanes, lane)
        p0, p1, p2, p3 = four(P, 4 * point * lanes, lane)
        J, at = a * d - b * c, 3 * point * lanes
        store(S, at, (d * p0 - b * p2) / J)
        store(S, at + lanes, (a * p3 - c * p1) / J)
        store(S, at + 2 * lanes, 0.5 * (d * p1 - b * p3 + a * p2 - c * p0) / J)


def times_symmetric(F: np.ndarray, xx: np.ndarray, yy: np.ndarray, xy: np.ndarray) -> np.ndarray:
    """F S for a symmetric S, [elements, points, 4, 1]."""
    a, b, c, d = np.moveaxis(F, -2, 0)
    return np.stack([a * xx + b * xy, a * xy + b * yy, c * xx + d * xy, c * xy + d * yy], axis=-2)


COEFFICIENTS = 7
SHEAR, LAME, VISCOUS_SHEAR, VISCOUS_LAME, BRANCH_SHEAR, BRANCH_LAME, FIBRE = range(COEFFICIENTS)


@njit(cache=True, fastmath=True, error_model="numpy")
def through_thickness_stretch(shear: float, lame: float, area_ratio: float) -> float:
    """Stretch f with no stress through the thickness: mu (f^2 - 1) + lambda ln(area_ratio f) = 0 (Newton)."""
    f = area_ratio ** (-lame / (lame + 2.0 * shear))
    for _ in range(50):
        step = (shear * (f * f - 1.0) + lame * np.log(area_ratio * f)) / (2.0 * shear * f + lame / f)
        f -= step
        if abs(step) < 1e-15:
            break
    return f


@njit(inline="always")
def thickness(shear: Value, lame: Value, area_ratio: Value, lane: LaneTuple) -> Value:
    """The same in every lane."""
    out = zero(lane)
    for n in range(len(lane)):
        out = with_lane(
            out, n, through_thickness_stretch(of_lane(shear, n), of_lane(lame, n), of_lane(area_ratio, n))
        )
    return out


@njit(cache=True, fastmath=True, error_model="numpy")
def first_piola(
    F: np.ndarray,
    rate: np.ndarray,
    coefficients: np.ndarray,
    muscle: np.ndarray,
    contraction: np.ndarray,
    history: np.ndarray,
    plane_stress: bool,
    P: np.ndarray,
    lane: LaneTuple,
) -> None:
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
                volume = J * thickness(mu, lam, J, lane)
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
def moduli(
    F: np.ndarray,
    rate: np.ndarray,
    coefficients: np.ndarray,
    muscle: np.ndarray,
    contraction: np.ndarray,
    history: np.ndarray,
    plane_stress: bool,
    elastic: np.ndarray,
    viscous: np.ndarray,
    lane: LaneTuple,
) -> None:
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
                f = thickness(mu, lam, J, lane)
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
