"""Deformation gradients at every Gauss point, and the Green strain and second Piola stress that go with them.

Every array has the lanes as its last axis (see `simd.py`) but those that describe the mesh: elements and gradients.
`stretch` is that of the stress-free shape along the body: gradients by x shrink with it. Indices of a deformation
gradient run 00, 01, 10, 11 (row-major).
"""

import numpy as np
from numba import njit

from hasel_sim.simd import four, load, store, zero


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


def times_symmetric(F: np.ndarray, xx: np.ndarray, yy: np.ndarray, xy: np.ndarray) -> np.ndarray:
    """F S for a symmetric S, [elements, points, 4, 1]."""
    a, b, c, d = np.moveaxis(F, -2, 0)
    return np.stack([a * xx + b * xy, a * xy + b * yy, c * xx + d * xy, c * xy + d * yy], axis=-2)
