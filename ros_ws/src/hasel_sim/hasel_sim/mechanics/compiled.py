"""Compiled loops over elements and Gauss points: internal force, moduli, banded assembly, directional derivatives.

Indices of a deformation gradient run 00, 01, 10, 11 (row-major). Coefficients per element, in this order:
shear modulus and Lamé's first parameter of the neo-Hookean solid [Pa], the same two of the viscous stress [Pa s], the
same two of the elastic stress that internal branches add within a step [Pa], fibre stiffness [Pa].

Neo-Hookean, W = mu/2 (I1 - 2 - 2 ln J) + lambda/2 (ln J)^2: P = mu (F - F^-T) + lambda ln J F^-T (Bonet and Wood,
Nonlinear Continuum Mechanics for Finite Element Analysis, section 6.4). Kelvin-Voigt:
S = lambda_v tr(dE/dt) I + 2 mu_v dE/dt. Fibre along x: 1/2 w (|F m| - (1 - a))^2.

A trial shape with an element of no area gives infinities, which end that trial, and no ZeroDivisionError.
"""

import numpy as np
from numba import njit

COEFFICIENTS = 7
SHEAR, LAME, VISCOUS_SHEAR, VISCOUS_LAME, BRANCH_SHEAR, BRANCH_LAME, FIBRE = range(COEFFICIENTS)


@njit(cache=True, fastmath=True, error_model="numpy")
def deformation(field, elements, gradients, out):
    """Gradient of a nodal field [nodes, 2] at every Gauss point, into out [elements, points, 4]."""
    for e in range(elements.shape[0]):
        for g in range(gradients.shape[1]):
            f00 = f01 = f10 = f11 = 0.0
            for a in range(8):
                node = elements[e, a]
                x, y = field[node, 0], field[node, 1]
                dx, dy = gradients[e, g, a, 0], gradients[e, g, a, 1]
                f00 += x * dx
                f01 += x * dy
                f10 += y * dx
                f11 += y * dy
            out[e, g, 0] = f00
            out[e, g, 1] = f01
            out[e, g, 2] = f10
            out[e, g, 3] = f11


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


@njit(cache=True, fastmath=True, error_model="numpy")
def first_piola(F, rate, coefficients, muscle, contraction, history, plane_stress, P):
    """First Piola stress [Pa] at every Gauss point.

    F, rate: deformation gradient and its rate, P: result, all [elements, points, 4]; contraction: [1 + muscles] with 0
    first; history: second Piola stress of the internal branches from earlier steps [elements, points, 3] (xx, yy, xy).
    """
    for e in range(F.shape[0]):
        mu, lam = coefficients[e, 0], coefficients[e, 1]
        muv, lamv = coefficients[e, 2], coefficients[e, 3]
        mub, lamb = coefficients[e, 4], coefficients[e, 5]
        w = coefficients[e, 6]
        rest = 1.0 - contraction[muscle[e]]
        for g in range(F.shape[1]):
            a, b, c, d = F[e, g, 0], F[e, g, 1], F[e, g, 2], F[e, g, 3]
            ra, rb, rc, rd = rate[e, g, 0], rate[e, g, 1], rate[e, g, 2], rate[e, g, 3]
            J = a * d - b * c
            volume = J
            if plane_stress:
                volume = J * through_thickness_stretch(mu, lam, J)
            q = (lam * np.log(volume) - mu) / J
            exx, eyy, exy = a * ra + c * rc, b * rb + d * rd, 0.5 * (a * rb + b * ra + c * rd + d * rc)
            sxx = lamv * (exx + eyy) + 2.0 * muv * exx + history[e, g, 0]
            syy = lamv * (exx + eyy) + 2.0 * muv * eyy + history[e, g, 1]
            sxy = 2.0 * muv * exy + history[e, g, 2]
            if mub != 0.0:
                gxx, gyy = 0.5 * (a * a + c * c - 1.0), 0.5 * (b * b + d * d - 1.0)
                sxx += lamb * (gxx + gyy) + 2.0 * mub * gxx
                syy += lamb * (gxx + gyy) + 2.0 * mub * gyy
                sxy += mub * (a * b + c * d)
            p0 = mu * a + q * d + a * sxx + b * sxy
            p1 = mu * b - q * c + a * sxy + b * syy
            p2 = mu * c - q * b + c * sxx + d * sxy
            p3 = mu * d + q * a + c * sxy + d * syy
            if w != 0.0:
                tension = w * (1.0 - rest / np.sqrt(a * a + c * c))
                p0 += tension * a
                p2 += tension * c
            P[e, g, 0] = p0
            P[e, g, 1] = p1
            P[e, g, 2] = p2
            P[e, g, 3] = p3


@njit(cache=True, fastmath=True, error_model="numpy")
def moduli(F, rate, coefficients, muscle, contraction, history, plane_stress, elastic, viscous):
    """Derivatives of the first Piola stress by F (elastic) and by its rate (viscous), [elements, points, 4, 4]."""
    inverse = np.empty((2, 2))
    deform = np.empty((2, 2))
    speed = np.empty((2, 2))
    S = np.empty((2, 2))
    for e in range(F.shape[0]):
        mu, lam = coefficients[e, 0], coefficients[e, 1]
        muv, lamv = coefficients[e, 2], coefficients[e, 3]
        mub, lamb = coefficients[e, 4], coefficients[e, 5]
        w = coefficients[e, 6]
        rest = 1.0 - contraction[muscle[e]]
        for g in range(F.shape[1]):
            a, b, c, d = F[e, g, 0], F[e, g, 1], F[e, g, 2], F[e, g, 3]
            ra, rb, rc, rd = rate[e, g, 0], rate[e, g, 1], rate[e, g, 2], rate[e, g, 3]
            deform[0, 0], deform[0, 1], deform[1, 0], deform[1, 1] = a, b, c, d
            speed[0, 0], speed[0, 1], speed[1, 0], speed[1, 1] = ra, rb, rc, rd
            J = a * d - b * c
            inverse[0, 0], inverse[0, 1], inverse[1, 0], inverse[1, 1] = d / J, -b / J, -c / J, a / J
            log_volume, bulk = np.log(J), lam
            if plane_stress:
                f = through_thickness_stretch(mu, lam, J)
                log_volume, bulk = np.log(J * f), lam * 2.0 * mu * f * f / (2.0 * mu * f * f + lam)
            exx, eyy, exy = a * ra + c * rc, b * rb + d * rd, 0.5 * (a * rb + b * ra + c * rd + d * rc)
            gxx, gyy = 0.5 * (a * a + c * c - 1.0), 0.5 * (b * b + d * d - 1.0)
            S[0, 0] = (
                lamv * (exx + eyy) + 2.0 * muv * exx + lamb * (gxx + gyy) + 2.0 * mub * gxx + history[e, g, 0]
            )
            S[1, 1] = (
                lamv * (exx + eyy) + 2.0 * muv * eyy + lamb * (gxx + gyy) + 2.0 * mub * gyy + history[e, g, 1]
            )
            S[0, 1] = 2.0 * muv * exy + mub * (a * b + c * d) + history[e, g, 2]
            S[1, 0] = S[0, 1]
            pull = mu - lam * log_volume
            for k in range(2):
                for L in range(2):
                    # variation of F (and of its rate) by the unit tensor e_k (x) e_L
                    dxx = speed[k, 0] if L == 0 else 0.0
                    dyy = speed[k, 1] if L == 1 else 0.0
                    dxy = 0.5 * speed[k, 1 - L]
                    hxx = deform[k, 0] if L == 0 else 0.0
                    hyy = deform[k, 1] if L == 1 else 0.0
                    hxy = 0.5 * deform[k, 1 - L]
                    exx_ = lamv * (dxx + dyy) + 2.0 * muv * dxx + lamb * (hxx + hyy) + 2.0 * mub * hxx
                    eyy_ = lamv * (dxx + dyy) + 2.0 * muv * dyy + lamb * (hxx + hyy) + 2.0 * mub * hyy
                    exy_ = 2.0 * muv * dxy + 2.0 * mub * hxy
                    vxx = lamv * (hxx + hyy) + 2.0 * muv * hxx
                    vyy = lamv * (hxx + hyy) + 2.0 * muv * hyy
                    vxy = 2.0 * muv * hxy
                    column = 2 * k + L
                    for i in range(2):
                        fx, fy = deform[i, 0], deform[i, 1]
                        viscous[e, g, 2 * i, column] = fx * vxx + fy * vxy
                        viscous[e, g, 2 * i + 1, column] = fx * vxy + fy * vyy
                        for j in range(2):
                            value = (
                                pull * inverse[j, k] * inverse[L, i] + bulk * inverse[j, i] * inverse[L, k]
                            )
                            if i == k:
                                value += S[L, j]
                                if j == L:
                                    value += mu
                            elastic[e, g, 2 * i + j, column] = value
                        elastic[e, g, 2 * i, column] += fx * exx_ + fy * exy_
                        elastic[e, g, 2 * i + 1, column] += fx * exy_ + fy * eyy_
            if w != 0.0:
                stretch = np.sqrt(a * a + c * c)
                tension, slope = w * (1.0 - rest / stretch), w * rest / stretch**3
                elastic[e, g, 0, 0] += tension + slope * a * a
                elastic[e, g, 0, 2] += slope * a * c
                elastic[e, g, 2, 0] += slope * a * c
                elastic[e, g, 2, 2] += tension + slope * c * c


@njit(cache=True, fastmath=True, error_model="numpy")
def scatter_stress(P, elements, gradients, areas, force):
    """Add the nodal forces of a stress field [elements, points, 4] to force [nodes, 2]."""
    local = np.empty((8, 2))
    for e in range(elements.shape[0]):
        local[:] = 0.0
        for g in range(P.shape[1]):
            s = areas[e, g]
            p0, p1, p2, p3 = s * P[e, g, 0], s * P[e, g, 1], s * P[e, g, 2], s * P[e, g, 3]
            for a in range(8):
                dx, dy = gradients[e, g, a, 0], gradients[e, g, a, 1]
                local[a, 0] += p0 * dx + p1 * dy
                local[a, 1] += p2 * dx + p3 * dy
        for a in range(8):
            force[elements[e, a], 0] += local[a, 0]
            force[elements[e, a], 1] += local[a, 1]


@njit(cache=True, fastmath=True, error_model="numpy")
def scatter_matrix(elastic, viscous, masses, weights, elements, gradients, areas, band, diagonal):
    """Add weights[0] K + weights[1] C + weights[2] M to a band matrix, entry (i, j) at [i, diagonal + j - i].

    elastic, viscous: moduli [elements, points, 4, 4]; masses: [elements, 8, 8].
    """
    local = np.empty((16, 16))
    half = np.empty((4, 16))
    by_position, by_velocity, by_acceleration = weights[0], weights[1], weights[2]
    for e in range(elements.shape[0]):
        for a in range(8):
            for b in range(8):
                mass = by_acceleration * masses[e, a, b]
                local[2 * a, 2 * b], local[2 * a, 2 * b + 1] = mass, 0.0
                local[2 * a + 1, 2 * b], local[2 * a + 1, 2 * b + 1] = 0.0, mass
        for g in range(elastic.shape[1]):
            s = by_position * areas[e, g]
            v = by_velocity * areas[e, g]
            for row in range(4):
                m0 = s * elastic[e, g, row, 0] + v * viscous[e, g, row, 0]
                m1 = s * elastic[e, g, row, 1] + v * viscous[e, g, row, 1]
                m2 = s * elastic[e, g, row, 2] + v * viscous[e, g, row, 2]
                m3 = s * elastic[e, g, row, 3] + v * viscous[e, g, row, 3]
                for b in range(8):
                    dx, dy = gradients[e, g, b, 0], gradients[e, g, b, 1]
                    half[row, 2 * b] = m0 * dx + m1 * dy
                    half[row, 2 * b + 1] = m2 * dx + m3 * dy
            for a in range(8):
                dx, dy = gradients[e, g, a, 0], gradients[e, g, a, 1]
                for column in range(16):
                    local[2 * a, column] += dx * half[0, column] + dy * half[1, column]
                    local[2 * a + 1, column] += dx * half[2, column] + dy * half[3, column]
        for a in range(8):
            for i in range(2):
                row = 2 * elements[e, a] + i
                for b in range(8):
                    j = diagonal + 2 * elements[e, b] - row
                    band[row, j] += local[2 * a + i, 2 * b]
                    band[row, j + 1] += local[2 * a + i, 2 * b + 1]


@njit(cache=True, fastmath=True, error_model="numpy")
def scatter_directions(moduli, stress, elements, gradients, areas, directions, force):
    """Add to force [columns, nodes, 2] the change of the nodal forces along many directions at once.

    moduli: [elements, points, 4, 4], by F or by its rate; directions: of the nodal positions or velocities
    [columns, nodes, 2]; stress: change of the first Piola stress that does not come from them,
    [columns, elements, points, 4], or an empty first axis for none.
    """
    local, here = np.empty((8, 2)), np.empty((8, 2))
    for e in range(elements.shape[0]):
        for c in range(directions.shape[0]):
            local[:] = 0.0
            for a in range(8):
                here[a, 0], here[a, 1] = directions[c, elements[e, a], 0], directions[c, elements[e, a], 1]
            for g in range(moduli.shape[1]):
                d0 = d1 = d2 = d3 = 0.0
                for a in range(8):
                    dx, dy = gradients[e, g, a, 0], gradients[e, g, a, 1]
                    d0 += here[a, 0] * dx
                    d1 += here[a, 0] * dy
                    d2 += here[a, 1] * dx
                    d3 += here[a, 1] * dy
                A, s = moduli[e, g], areas[e, g]
                p0 = A[0, 0] * d0 + A[0, 1] * d1 + A[0, 2] * d2 + A[0, 3] * d3
                p1 = A[1, 0] * d0 + A[1, 1] * d1 + A[1, 2] * d2 + A[1, 3] * d3
                p2 = A[2, 0] * d0 + A[2, 1] * d1 + A[2, 2] * d2 + A[2, 3] * d3
                p3 = A[3, 0] * d0 + A[3, 1] * d1 + A[3, 2] * d2 + A[3, 3] * d3
                if stress.shape[0] > 0:
                    p0 += stress[c, e, g, 0]
                    p1 += stress[c, e, g, 1]
                    p2 += stress[c, e, g, 2]
                    p3 += stress[c, e, g, 3]
                for a in range(8):
                    dx, dy = s * gradients[e, g, a, 0], s * gradients[e, g, a, 1]
                    local[a, 0] += p0 * dx + p1 * dy
                    local[a, 1] += p2 * dx + p3 * dy
            for a in range(8):
                node = elements[e, a]
                force[c, node, 0] += local[a, 0]
                force[c, node, 1] += local[a, 1]


@njit(cache=True, fastmath=True, error_model="numpy")
def scatter_pulled_back(elastic, viscous, elements, gradients, areas, weights, force):
    """Add to force [2, nodes, 2] the transposed stiffness and damping times nodal weights [nodes, 2]."""
    local = np.empty((2, 8, 2))
    for e in range(elements.shape[0]):
        local[:] = 0.0
        for g in range(elastic.shape[1]):
            d0 = d1 = d2 = d3 = 0.0
            for a in range(8):
                node = elements[e, a]
                dx, dy = gradients[e, g, a, 0], gradients[e, g, a, 1]
                d0 += weights[node, 0] * dx
                d1 += weights[node, 0] * dy
                d2 += weights[node, 1] * dx
                d3 += weights[node, 1] * dy
            A, B, s = elastic[e, g], viscous[e, g], areas[e, g]
            p0 = s * (A[0, 0] * d0 + A[1, 0] * d1 + A[2, 0] * d2 + A[3, 0] * d3)
            p1 = s * (A[0, 1] * d0 + A[1, 1] * d1 + A[2, 1] * d2 + A[3, 1] * d3)
            p2 = s * (A[0, 2] * d0 + A[1, 2] * d1 + A[2, 2] * d2 + A[3, 2] * d3)
            p3 = s * (A[0, 3] * d0 + A[1, 3] * d1 + A[2, 3] * d2 + A[3, 3] * d3)
            q0 = s * (B[0, 0] * d0 + B[1, 0] * d1 + B[2, 0] * d2 + B[3, 0] * d3)
            q1 = s * (B[0, 1] * d0 + B[1, 1] * d1 + B[2, 1] * d2 + B[3, 1] * d3)
            q2 = s * (B[0, 2] * d0 + B[1, 2] * d1 + B[2, 2] * d2 + B[3, 2] * d3)
            q3 = s * (B[0, 3] * d0 + B[1, 3] * d1 + B[2, 3] * d2 + B[3, 3] * d3)
            for a in range(8):
                dx, dy = gradients[e, g, a, 0], gradients[e, g, a, 1]
                local[0, a, 0] += p0 * dx + p1 * dy
                local[0, a, 1] += p2 * dx + p3 * dy
                local[1, a, 0] += q0 * dx + q1 * dy
                local[1, a, 1] += q2 * dx + q3 * dy
        for a in range(8):
            node = elements[e, a]
            for row in range(2):
                force[row, node, 0] += local[row, a, 0]
                force[row, node, 1] += local[row, a, 1]


@njit(cache=True, fastmath=True, error_model="numpy")
def contraction_force(F, coefficients, muscle, elements, gradients, areas, force):
    """Derivative of the internal force by the contraction of each muscle, into force [muscles, nodes, 2]."""
    force[:] = 0.0
    for e in range(elements.shape[0]):
        if muscle[e] == 0:
            continue
        for g in range(F.shape[1]):
            a, c = F[e, g, 0], F[e, g, 2]
            pull = coefficients[e, 6] * areas[e, g] / np.sqrt(a * a + c * c)
            for n in range(8):
                dx = gradients[e, g, n, 0]
                force[muscle[e] - 1, elements[e, n], 0] += pull * a * dx
                force[muscle[e] - 1, elements[e, n], 1] += pull * c * dx


@njit(cache=True, fastmath=True, error_model="numpy")
def mass_product(masses, elements, columns, out):
    """Add to out [columns, nodes, 2] the element masses [elements, 8, 8] times the nodal vectors."""
    for e in range(elements.shape[0]):
        for c in range(columns.shape[0]):
            for a in range(8):
                x = y = 0.0
                for b in range(8):
                    x += masses[e, a, b] * columns[c, elements[e, b], 0]
                    y += masses[e, a, b] * columns[c, elements[e, b], 1]
                out[c, elements[e, a], 0] += x
                out[c, elements[e, a], 1] += y


@njit(cache=True, fastmath=True, error_model="numpy")
def scatter_sites(direct, along, nodes, shape, slope, measure, band, diagonal):
    """Add site matrices [n, 2, 2], for values (direct) and tangents (along) of the field, to a band matrix."""
    for s in range(nodes.shape[0]):
        for a in range(nodes.shape[1]):
            weight = measure[s] * shape[s, a]
            for i in range(2):
                row = 2 * nodes[s, a] + i
                d0, d1 = weight * direct[s, i, 0], weight * direct[s, i, 1]
                t0, t1 = weight * along[s, i, 0], weight * along[s, i, 1]
                for b in range(nodes.shape[1]):
                    j = diagonal + 2 * nodes[s, b] - row
                    band[row, j] += d0 * shape[s, b] + t0 * slope[s, b]
                    band[row, j + 1] += d1 * shape[s, b] + t1 * slope[s, b]


@njit(cache=True, fastmath=True, error_model="numpy")
def second_piola(F, P, S):
    """Symmetric second Piola stress (xx, yy, xy) F^-1 P [elements, points, 3] of a first Piola stress."""
    for e in range(F.shape[0]):
        for g in range(F.shape[1]):
            a, b, c, d = F[e, g, 0], F[e, g, 1], F[e, g, 2], F[e, g, 3]
            J = a * d - b * c
            S[e, g, 0] = (d * P[e, g, 0] - b * P[e, g, 2]) / J
            S[e, g, 1] = (a * P[e, g, 3] - c * P[e, g, 1]) / J
            S[e, g, 2] = 0.5 * (d * P[e, g, 1] - b * P[e, g, 3] + a * P[e, g, 2] - c * P[e, g, 0]) / J


@njit(cache=True, fastmath=True, error_model="numpy")
def exchange_initial_stress(elastic, old, new):
    """Replace the second Piola stress (xx, yy, xy) whose geometric stiffness is in the moduli, in place."""
    for e in range(elastic.shape[0]):
        for g in range(elastic.shape[1]):
            xx = new[e, g, 0] - old[e, g, 0]
            yy = new[e, g, 1] - old[e, g, 1]
            xy = new[e, g, 2] - old[e, g, 2]
            for i in (0, 2):
                elastic[e, g, i, i] += xx
                elastic[e, g, i + 1, i + 1] += yy
                elastic[e, g, i, i + 1] += xy
                elastic[e, g, i + 1, i] += xy
