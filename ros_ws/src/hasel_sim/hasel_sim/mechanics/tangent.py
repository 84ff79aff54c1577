"""Derivatives of the first Piola stress at a Gauss point, as rows of four by F00, F01, F10, F11; inlined where used.

Laws, coefficients and sources are those of `compiled`.
"""

from numba import njit


@njit(inline="always")
def _along(own, f, trace, rest, turned, lane):
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
def _across(own, f, trace, rest, turned, lane):
    """The same for a component in column 1."""
    return (
        own * trace[0] + f[0] * rest[1],
        own * trace[1] + f[1] * rest[1] + turned[0],
        own * trace[2] + f[0] * rest[3],
        own * trace[3] + f[1] * rest[3] + turned[1],
    )


@njit(inline="always")
def viscous_rows(F, rate, by_F, by_rate, lane):
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
def add_elastic_rows(rows, F, inverse, bulk, pull, held, slope, lane):
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
