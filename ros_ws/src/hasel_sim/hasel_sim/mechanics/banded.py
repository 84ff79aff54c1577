"""A narrow-banded matrix per lane and its LU factors."""

import numpy as np

from hasel_sim.errors import SimulationError
from hasel_sim.mechanics import banded_lu
from hasel_sim.simd import lane_tuple


def singular_matrix(unknown: int) -> SimulationError:
    """What is said of a matrix in which the pivot of an unknown vanishes."""
    return SimulationError(
        f"the tangent matrix is singular (unknown {unknown}); a body free to move has no static equilibrium, "
        "and extreme parameters have none either: clamp the body or move the parameters back into range"
    )


class BandMatrix:
    """Entry (i, j) of each lane is stored at [i, diagonal + j - i] of `entries`, so that `factorise` works in place.

    reach: how far right and down of the diagonal anything lies, fill-in included, for every unknown [unknowns]; the
    largest is the half bandwidth. The first `held` unknowns are fixed at zero: solutions leave them out.
    """

    def __init__(self, reach: np.ndarray, held: int = 0, lanes: int = 1) -> None:
        half_bandwidth, unknowns = int(reach.max()), len(reach)
        self.unknowns, self.half_bandwidth, self.held, self.reach = unknowns, half_bandwidth, held, reach
        self.diagonal = banded_lu.LEFT + half_bandwidth
        # odd, lest the rows of a column share one set of the cache
        width = (banded_lu.LEFT + 2 * half_bandwidth + 1 + banded_lu.RIGHT) | 1
        self.entries = np.zeros((unknowns + half_bandwidth + 8, width, lanes))

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
        banded_lu.factorise(inner, free, self.half_bandwidth, reach, bad, lane_tuple(lanes))
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
            banded_lu.solve_transposed(self._factors, n, k, self._reach, padded, lane_tuple(lanes))
        else:
            banded_lu.solve(self._factors, n, k, self._reach, padded, 0, lane_tuple(lanes))
        if held:
            padded = np.concatenate([np.zeros((count, held, lanes)), padded], axis=1)
        return padded[:, : held + n].reshape(columns.shape)
