# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A narrow-banded matrix per lane, its LU factors without pivoting, and solves with them.

Four pivots and four rows are eliminated at a time. For the nearly symmetric positive definite matrices of a time step
no pivoting is needed, which halves the work and keeps the band narrow; Newton's method and iterative refinement see to
what little accuracy it may cost (Golub and Van Loan, Matrix Computations, sections 4.1 and 4.3).

Row i is stored in one line, entry (i, j) at [i, LEFT + k + j - i] with k the half bandwidth, between paddings of zeros
that spare the loops all questions about the band's ends; the lanes are the last axis. Below the n rows come at least
k + 8 padding rows. Where the body is thin the band is narrower: `reach` says, for every unknown, how far right and down
of the diagonal anything lies, fill-in included.
"""

import numpy as np
from numba import njit

from hasel_sim.errors import SimulationError
from hasel_sim.simd import Four, LaneTuple, Value, four, lane_tuple, load, of_lane, store, zero

LEFT, RIGHT = 6, 3
MatrixOfLoops = tuple[np.ndarray, np.ndarray, tuple[int, int, int], np.ndarray]
"""`matrix` of the compiled loops, see `time_loop`."""


@njit(inline="always")
def _multipliers(
    A: np.ndarray,
    at: int,
    upper: tuple[Value, Value, Value, Value, Value, Value],
    inverse: Four,
    lane: LaneTuple,
) -> Four:
    """Multipliers of one row for four pivot rows, stored in the place of what they eliminate."""
    lanes = len(lane)
    f0 = load(A, at, lane) * inverse[0]
    f1 = (load(A, at + lanes, lane) - f0 * upper[0]) * inverse[1]
    f2 = (load(A, at + 2 * lanes, lane) - f0 * upper[1] - f1 * upper[3]) * inverse[2]
    f3 = (load(A, at + 3 * lanes, lane) - f0 * upper[2] - f1 * upper[4] - f2 * upper[5]) * inverse[3]
    store(A, at, f0)
    store(A, at + lanes, f1)
    store(A, at + 2 * lanes, f2)
    store(A, at + 3 * lanes, f3)
    return f0, f1, f2, f3


@njit(cache=True, fastmath=True, error_model="numpy")
def lu_factorise(A: np.ndarray, n: int, k: int, reach: np.ndarray, bad: np.ndarray, lane: LaneTuple) -> None:
    """Overwrite A [rows, width, lanes] with its factors (unit lower triangle, upper triangle).

    bad [lanes] takes the first unknown whose pivot vanishes beside the matrix's own diagonal; it comes in as -1.
    """
    lanes, line = len(lane), A.shape[1] * len(lane)
    for first in range(0, n, 4):
        m = reach[min(first + 3, n - 1)]
        d0 = first * line + (LEFT + k) * lanes
        d1, d2, d3 = d0 + line, d0 + 2 * line, d0 + 3 * line
        own = load(A, d0, lane), load(A, d1, lane), load(A, d2, lane), load(A, d3, lane)
        for p in range(3):
            pivot = d0 + p * line
            inverse = 1.0 / load(A, pivot, lane)
            for d in range(1, 4 - p):
                row = pivot + d * (line - lanes)
                f = load(A, row, lane) * inverse
                store(A, row, f)
                for t in range(lanes, (m + 4 - p) * lanes, lanes):
                    store(A, row + t, load(A, row + t, lane) - f * load(A, pivot + t, lane))
        pivots = load(A, d0, lane), load(A, d1, lane), load(A, d2, lane), load(A, d3, lane)
        for n_lane in range(lanes):
            for p in range(4):
                pivot_size, own_size = abs(of_lane(pivots[p], n_lane)), abs(of_lane(own[p], n_lane))
                if bad[n_lane] < 0 and not pivot_size > 1e-13 * own_size:
                    bad[n_lane] = first + p
        inverses = 1.0 / pivots[0], 1.0 / pivots[1], 1.0 / pivots[2], 1.0 / pivots[3]
        upper = (
            load(A, d0 + lanes, lane),
            load(A, d0 + 2 * lanes, lane),
            load(A, d0 + 3 * lanes, lane),
            load(A, d1 + lanes, lane),
            load(A, d1 + 2 * lanes, lane),
            load(A, d2 + lanes, lane),
        )
        q0, q1, q2, q3 = d0 + 4 * lanes, d1 + 3 * lanes, d2 + 2 * lanes, d3 + lanes
        for i in range(first + 4, first + 4 + m, 4):
            s0 = i * line + (LEFT + k + first - i) * lanes
            s1, s2, s3 = s0 + line - lanes, s0 + 2 * (line - lanes), s0 + 3 * (line - lanes)
            a0, a1, a2, a3 = _multipliers(A, s0, upper, inverses, lane)
            b0, b1, b2, b3 = _multipliers(A, s1, upper, inverses, lane)
            c0, c1, c2, c3 = _multipliers(A, s2, upper, inverses, lane)
            e0, e1, e2, e3 = _multipliers(A, s3, upper, inverses, lane)
            s0, s1, s2, s3 = s0 + 4 * lanes, s1 + 4 * lanes, s2 + 4 * lanes, s3 + 4 * lanes
            for t in range(0, m * lanes, lanes):
                x, y = load(A, q0 + t, lane), load(A, q1 + t, lane)
                z, w = load(A, q2 + t, lane), load(A, q3 + t, lane)
                store(A, s0 + t, load(A, s0 + t, lane) - (a0 * x + a1 * y + a2 * z + a3 * w))
                store(A, s1 + t, load(A, s1 + t, lane) - (b0 * x + b1 * y + b2 * z + b3 * w))
                store(A, s2 + t, load(A, s2 + t, lane) - (c0 * x + c1 * y + c2 * z + c3 * w))
                store(A, s3 + t, load(A, s3 + t, lane) - (e0 * x + e1 * y + e2 * z + e3 * w))


@njit(inline="always")
def _store_four(array: np.ndarray, at: int, values: Four, lane: LaneTuple) -> None:
    lanes = len(lane)
    store(array, at, values[0])
    store(array, at + lanes, values[1])
    store(array, at + 2 * lanes, values[2])
    store(array, at + 3 * lanes, values[3])


@njit(inline="always")
def _less_products(
    A: np.ndarray,
    rows: tuple[int, int, int, int],
    x: np.ndarray,
    place: int,
    count: int,
    y: Four,
    lane: LaneTuple,
) -> Four:
    """Four entries y less the products of four rows of A with `count` entries of x."""
    lanes = len(lane)
    r0, r1, r2, r3 = rows
    y0, y1, y2, y3 = y
    for t in range(0, count * lanes, lanes):
        known = load(x, place + t, lane)
        y0, y1 = y0 - load(A, r0 + t, lane) * known, y1 - load(A, r1 + t, lane) * known
        y2, y3 = y2 - load(A, r2 + t, lane) * known, y3 - load(A, r3 + t, lane) * known
    return y0, y1, y2, y3


@njit(cache=True, fastmath=True, error_model="numpy")
def lu_solve(
    A: np.ndarray, n: int, k: int, reach: np.ndarray, x: np.ndarray, skipped: int, lane: LaneTuple
) -> None:
    """Solve in place for the columns x [columns, skipped + n + k + 4, lanes], each of which ends with k + 4 zeros."""
    lanes, line, middle = len(lane), A.shape[1] * len(lane), LEFT + k
    columns, height, begin = x.shape[0], x.shape[1] * len(lane), skipped * len(lane)
    first = 0
    for i in range(0, n, 4):
        while first + reach[first] < i:
            first += 1
        d = i * line + middle * lanes
        back = (first - i) * lanes
        rows = d + back, d + line - lanes + back, d + 2 * (line - lanes) + back, d + 3 * (line - lanes) + back
        f1 = load(A, d + line - lanes, lane)
        f2, g2 = load(A, d + 2 * (line - lanes), lane), load(A, d + 2 * line - lanes, lane)
        f3, g3 = load(A, d + 3 * (line - lanes), lane), load(A, d + 3 * line - 2 * lanes, lane)
        h3 = load(A, d + 3 * line - lanes, lane)
        for c in range(columns):
            at = begin + c * height + i * lanes
            y0, y1, y2, y3 = _less_products(A, rows, x, at + back, i - first, four(x, at, lane), lane)
            y1 = y1 - f1 * y0
            y2 = y2 - f2 * y0 - g2 * y1
            _store_four(x, at, (y0, y1, y2, y3 - f3 * y0 - g3 * y1 - h3 * y2), lane)
    for i in range(4 * ((n - 1) // 4), -1, -4):
        last = min(i + 3, n - 1)
        d = i * line + middle * lanes
        rows = d + 4 * lanes, d + line + 3 * lanes, d + 2 * line + 2 * lanes, d + 3 * line + lanes
        _, f0, g0, h0 = four(A, d, lane)
        f1, g1 = load(A, d + line + lanes, lane), load(A, d + line + 2 * lanes, lane)
        f2 = load(A, d + 2 * line + lanes, lane)
        i0, i1 = 1.0 / load(A, d, lane), 1.0 / load(A, d + line, lane)
        i2, i3 = 1.0 / load(A, d + 2 * line, lane), 1.0 / load(A, d + 3 * line, lane)
        count = last + reach[last] - i - 3
        for c in range(columns):
            at = begin + c * height + i * lanes
            place = at + 4 * lanes
            y0, y1, y2, y3 = _less_products(A, rows, x, place, count, four(x, at, lane), lane)
            y3 = y3 * i3
            y2 = (y2 - f2 * y3) * i2
            y1 = (y1 - f1 * y2 - g1 * y3) * i1
            _store_four(x, at, ((y0 - f0 * y1 - g0 * y2 - h0 * y3) * i0, y1, y2, y3), lane)
    for c in range(columns):
        for at in range(begin + c * height + n * lanes, (c + 1) * height, lanes):
            store(x, at, zero(lane))


@njit(cache=True, fastmath=True, error_model="numpy")
def lu_solve_transposed(
    A: np.ndarray, n: int, k: int, reach: np.ndarray, x: np.ndarray, lane: LaneTuple
) -> None:
    """The same with the transposed matrix."""
    lanes, line, middle = len(lane), A.shape[1] * len(lane), LEFT + k
    columns, height = x.shape[0], x.shape[1] * len(lane)
    for i in range(n):
        diagonal = i * line + middle * lanes
        for c in range(columns):
            at = c * height + i * lanes
            value = load(x, at, lane) / load(A, diagonal, lane)
            store(x, at, value)
            for t in range(lanes, (reach[i] + 1) * lanes, lanes):
                store(x, at + t, load(x, at + t, lane) - load(A, diagonal + t, lane) * value)
    for i in range(n - 1, -1, -1):
        diagonal = i * line + middle * lanes
        for c in range(columns):
            at = c * height + i * lanes
            value = load(x, at, lane)
            for t in range(lanes, (min(i, k) + 1) * lanes, lanes):
                store(x, at - t, load(x, at - t, lane) - load(A, diagonal - t, lane) * value)


@njit(cache=True, fastmath=True, error_model="numpy")
def clear_band(band: np.ndarray, reach: np.ndarray, diagonal: int, lane: LaneTuple) -> None:
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


@njit(cache=True, error_model="numpy")
def is_spoilt(vector: np.ndarray, unknowns: int, bad: np.ndarray) -> bool:
    """Whether factors may have left what is no number beyond the band, where `clear_band` does not look."""
    spoilt = False
    for k in range(len(bad)):
        spoilt = spoilt or bad[k] >= 0 or not np.isfinite(vector[unknowns // 2 - 1, 1, k])
    return spoilt


@njit(cache=True, fastmath=True, error_model="numpy")
def factorise(matrix: MatrixOfLoops, bad: np.ndarray, lane: LaneTuple) -> None:
    """Replace a band matrix by its factors; bad [lanes]: see `factorise`."""
    band, reach, (diagonal, half_bandwidth, held), _ = matrix
    n, lanes = len(reach), len(lane)
    line = band.shape[1] * lanes
    for row in range(held, min(held + half_bandwidth, n)):
        for at in range(row * line, row * line + (diagonal + held - row) * lanes, lanes):
            store(band, at, zero(lane))
    for row in range(n, band.shape[0]):
        store(band, row * line + diagonal * lanes, zero(lane) + 1.0)
    lu_factorise(band[held:], n - held, half_bandwidth, reach[held:], bad, lane)


@njit(inline="always")
def _unknowns_of(columns: np.ndarray, c: int, unknowns: int, held: int, lane: LaneTuple) -> np.ndarray:
    """One right-hand side [1, unknowns and padding, lanes] from the first unknown that is not held, all others zero."""
    lanes = len(lane)
    height = 2 * columns.shape[1] * lanes
    for at in range(c * height, c * height + held * lanes, lanes):
        store(columns, at, zero(lane))
    for at in range(c * height + unknowns * lanes, (c + 1) * height, lanes):
        store(columns, at, zero(lane))
    own = columns.reshape(columns.shape[0], 2 * columns.shape[1], lanes)[c, held:]
    return own.reshape(1, own.shape[0], lanes)


@njit(cache=True, fastmath=True, error_model="numpy")
def solve(matrix: MatrixOfLoops, columns: np.ndarray, lane: LaneTuple) -> None:
    """Solve in place with the factors for right-hand sides [columns, nodes and padding, 2, lanes]."""
    band, reach, (_, half_bandwidth, held), _ = matrix
    n = len(reach)
    for c in range(columns.shape[0]):
        _unknowns_of(columns, c, n, held, lane)
    every = columns.reshape(columns.shape[0], 2 * columns.shape[1], len(lane))
    lu_solve(band[held:], n - held, half_bandwidth, reach[held:], every, held, lane)


@njit(cache=True, fastmath=True, error_model="numpy")
def solve_transposed(matrix: MatrixOfLoops, columns: np.ndarray, lane: LaneTuple) -> None:
    """The same with the transposed matrix."""
    band, reach, (_, half_bandwidth, held), _ = matrix
    n = len(reach)
    for c in range(columns.shape[0]):
        own = _unknowns_of(columns, c, n, held, lane)
        lu_solve_transposed(band[held:], n - held, half_bandwidth, reach[held:], own, lane)


def singular_matrix(unknown: int) -> SimulationError:
    """What is said of a matrix in which the pivot of an unknown vanishes."""
    return SimulationError(
        f"the tangent matrix is singular (unknown {unknown}); a body free to move has no static equilibrium, "
        "and extreme parameters have none either: clamp the body or move the parameters back into range"
    )


class BandMatrix:
    """Entry (i, j) of each lane is stored at [i, diagonal + j - i] of `entries`, so that `factorise` works in place.

    reach: how far right and down of the diagonal anything lies, fill-in included, for every unknown [unknowns]; the
    largest is the half bandwidth. The first `held` unknowns are fixed at zero: solutions leave them out. padding: nodes
    behind those of the mesh that a right-hand side of the compiled loops has.
    """

    def __init__(self, reach: np.ndarray, held: int = 0, lanes: int = 1) -> None:
        half_bandwidth, unknowns = int(reach.max()), len(reach)
        self.unknowns, self.half_bandwidth, self.held, self.reach = unknowns, half_bandwidth, held, reach
        self.diagonal = LEFT + half_bandwidth
        # odd, lest the rows of a column share one set of the cache
        width = (LEFT + 2 * half_bandwidth + 1 + RIGHT) | 1
        self.entries = np.zeros((unknowns + half_bandwidth + 8, width, lanes))
        self.padding = half_bandwidth + 4

    @property
    def for_loops(self) -> MatrixOfLoops:
        """`matrix` of the compiled loops, see `time_loop`."""
        shape = self.diagonal, self.half_bandwidth, self.held
        return self.entries, self.reach, shape, np.zeros(1, dtype=bool)

    def factorise(self) -> "BandFactors":
        """LU factors without pivoting; the matrix itself is used up.

        Raises SimulationError when the matrix of every lane is singular; `BandFactors.singular` tells which are.
        """
        lanes = self.entries.shape[2]
        if self.held:
            for row in range(self.held, min(self.held + self.half_bandwidth, self.unknowns)):
                self.entries[row, : self.diagonal + self.held - row] = 0.0
        self.entries[self.unknowns :, self.diagonal] = 1.0
        inner, free = self.entries[self.held :], self.unknowns - self.held
        reach, bad = self.reach[self.held :], np.full(lanes, -1)
        lu_factorise(inner, free, self.half_bandwidth, reach, bad, lane_tuple(lanes))
        if (bad >= 0).all():
            raise singular_matrix(bad[0])
        return BandFactors(inner, reach, self.half_bandwidth, self.held, bad >= 0)


class BandFactors:
    """Solves with the factors of a `BandMatrix`; valid until that matrix is used again.

    singular: whether each lane's matrix was, [lanes].
    """

    def __init__(
        self, factors: np.ndarray, reach: np.ndarray, half_bandwidth: int, held: int, singular: np.ndarray
    ) -> None:
        self._factors, self._reach, self.singular = factors, reach, singular
        self._half_bandwidth, self._held = half_bandwidth, held

    def solve(self, columns: np.ndarray, transposed: bool = False) -> np.ndarray:
        """Solution for each right-hand side [columns, nodes, 2, lanes]; held unknowns come back as zero."""
        k, n, held = self._half_bandwidth, len(self._reach), self._held
        count, lanes = len(columns), columns.shape[-1]
        padded = np.empty((count, n + k + 4, lanes))
        padded[:, n:] = 0.0
        padded[:, :n] = columns.reshape(count, held + n, lanes)[:, held:]
        if transposed:
            lu_solve_transposed(self._factors, n, k, self._reach, padded, lane_tuple(lanes))
        else:
            lu_solve(self._factors, n, k, self._reach, padded, 0, lane_tuple(lanes))
        if held:
            padded = np.concatenate([np.zeros((count, held, lanes)), padded], axis=1)
        return padded[:, : held + n].reshape(columns.shape)
