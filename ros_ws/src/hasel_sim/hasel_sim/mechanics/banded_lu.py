"""LU factors of a banded matrix without pivoting, four pivots and four rows at a time.

For the nearly symmetric positive definite matrices of a time step no pivoting is needed, which halves the work and
keeps the band narrow; Newton's method and iterative refinement see to what little accuracy it may cost (Golub and Van
Loan, Matrix Computations, sections 4.1 and 4.3).

Row i is stored in one line, entry (i, j) at [i, LEFT + k + j - i] with k the half bandwidth, between paddings of zeros
that spare the loops all questions about the band's ends. Below the n rows come at least k + 8 padding rows.
Where the body is thin the band is narrower: `reach` says, for every unknown, how far right and down of the diagonal
anything lies, fill-in included.
"""

import numpy as np
from numba import njit

LEFT, RIGHT = 6, 3


@njit(inline="always")
def _multipliers(row, at, u, inverse):
    """Multipliers of one row for four pivot rows, stored in the place of what they eliminate."""
    f0 = row[at] * inverse[0]
    f1 = (row[at + 1] - f0 * u[0]) * inverse[1]
    f2 = (row[at + 2] - f0 * u[1] - f1 * u[3]) * inverse[2]
    f3 = (row[at + 3] - f0 * u[2] - f1 * u[4] - f2 * u[5]) * inverse[3]
    row[at], row[at + 1], row[at + 2], row[at + 3] = f0, f1, f2, f3
    return f0, f1, f2, f3


@njit(cache=True, fastmath=True, error_model="numpy")
def factorise(A, n, k, reach):
    """Overwrite A with its factors (unit lower triangle, upper triangle).

    Returns the number of the first unknown whose pivot vanishes beside the matrix's own diagonal, or -1.
    """
    middle = LEFT + k
    bad = -1
    inverse, u, own = np.empty(4), np.empty(6), np.empty(4)
    for first in range(0, n, 4):
        for p in range(4):
            own[p] = abs(A[first + p, middle])
        for p in range(3):
            pivot_row = A[first + p]
            for d in range(1, 4 - p):
                row = A[first + p + d]
                f = row[middle - d] / pivot_row[middle]
                row[middle - d] = f
                for t in range(1, k + 1):
                    row[middle - d + t] -= f * pivot_row[middle + t]
        for p in range(4):
            pivot = A[first + p, middle]
            if bad < 0 and not abs(pivot) > 1e-13 * own[p]:
                bad = first + p
            inverse[p] = 1.0 / pivot
        u[0], u[1], u[2] = A[first, middle + 1], A[first, middle + 2], A[first, middle + 3]
        u[3], u[4] = A[first + 1, middle + 1], A[first + 1, middle + 2]
        u[5] = A[first + 2, middle + 1]
        m = reach[min(first + 3, n - 1)]
        r0 = A[first, middle + 4 : middle + 4 + m]
        r1 = A[first + 1, middle + 3 : middle + 3 + m]
        r2 = A[first + 2, middle + 2 : middle + 2 + m]
        r3 = A[first + 3, middle + 1 : middle + 1 + m]
        for i in range(first + 4, first + 4 + m, 4):
            at = middle + first - i
            a0, a1, a2, a3 = _multipliers(A[i], at, u, inverse)
            b0, b1, b2, b3 = _multipliers(A[i + 1], at - 1, u, inverse)
            c0, c1, c2, c3 = _multipliers(A[i + 2], at - 2, u, inverse)
            d0, d1, d2, d3 = _multipliers(A[i + 3], at - 3, u, inverse)
            s0 = A[i, at + 4 : at + 4 + m]
            s1 = A[i + 1, at + 3 : at + 3 + m]
            s2 = A[i + 2, at + 2 : at + 2 + m]
            s3 = A[i + 3, at + 1 : at + 1 + m]
            for t in range(m):
                x, y, z, w = r0[t], r1[t], r2[t], r3[t]
                s0[t] -= a0 * x + a1 * y + a2 * z + a3 * w
                s1[t] -= b0 * x + b1 * y + b2 * z + b3 * w
                s2[t] -= c0 * x + c1 * y + c2 * z + c3 * w
                s3[t] -= d0 * x + d1 * y + d2 * z + d3 * w
    return bad


@njit(cache=True, fastmath=True)
def solve(A, n, k, reach, x):
    """Solve in place for every right-hand side in x [columns, n + k], which ends with k zeros."""
    middle = LEFT + k
    columns = x.shape[0]
    first = 0
    for i in range(n):
        while first + reach[first] < i:
            first += 1
        lower = A[i, middle - (i - first) : middle]
        for c in range(columns):
            before = x[c, first:i]
            total = 0.0
            for t in range(i - first):
                total += lower[t] * before[t]
            x[c, i] -= total
    for i in range(n - 1, -1, -1):
        m = reach[i]
        upper = A[i, middle + 1 : middle + 1 + m]
        inverse = 1.0 / A[i, middle]
        for c in range(columns):
            behind = x[c, i + 1 : i + 1 + m]
            total = 0.0
            for t in range(m):
                total += upper[t] * behind[t]
            x[c, i] = (x[c, i] - total) * inverse


@njit(cache=True, fastmath=True)
def solve_transposed(A, n, k, reach, x):
    """The same with the transposed matrix."""
    middle = LEFT + k
    for i in range(n):
        m = reach[i]
        upper = A[i, middle + 1 : middle + 1 + m]
        for c in range(x.shape[0]):
            value = x[c, i] / A[i, middle]
            x[c, i] = value
            behind = x[c, i + 1 : i + 1 + m]
            for t in range(m):
                behind[t] -= upper[t] * value
    for i in range(n - 1, -1, -1):
        m = min(i, k)
        lower = A[i, middle - m : middle]
        for c in range(x.shape[0]):
            value = x[c, i]
            before = x[c, i - m : i]
            for t in range(m):
                before[t] -= lower[t] * value
