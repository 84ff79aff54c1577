"""A narrow-banded matrix and its LU factors."""

import numpy as np

from hasel_sim.errors import SimulationError
from hasel_sim.mechanics import banded_lu


class BandMatrix:
    """Entry (i, j) is stored at [i, diagonal + j - i] of `entries`, so that `factorise` works in place.

    reach: how far right and down of the diagonal anything lies, fill-in included, for every unknown [unknowns]; the
    largest is the half bandwidth. The first `held` unknowns are fixed at zero: solutions leave them out.
    """

    def __init__(self, reach: np.ndarray, held: int = 0) -> None:
        half_bandwidth, unknowns = int(reach.max()), len(reach)
        self.unknowns, self.half_bandwidth, self.held, self.reach = unknowns, half_bandwidth, held, reach
        self.diagonal = banded_lu.LEFT + half_bandwidth
        width = banded_lu.LEFT + 2 * half_bandwidth + 1 + banded_lu.RIGHT
        self.entries = np.zeros((unknowns + half_bandwidth + 8, width))

    def clear(self) -> None:
        """Set every entry to zero."""
        self.entries.fill(0.0)

    def factorise(self) -> "BandFactors":
        """LU factors without pivoting; the matrix itself is used up.

        Raises SimulationError when it is singular.
        """
        if self.held:
            for row in range(self.held, min(self.held + self.half_bandwidth, self.unknowns)):
                self.entries[row, : self.diagonal + self.held - row] = 0.0
        self.entries[self.unknowns :, self.diagonal] = 1.0
        inner, free = self.entries[self.held :], self.unknowns - self.held
        reach = self.reach[self.held :]
        bad = banded_lu.factorise(inner, free, self.half_bandwidth, reach)
        if bad >= 0:
            raise SimulationError(
                f"the tangent matrix is singular (unknown {bad}); a body free to move has no static equilibrium, "
                "and extreme parameters have none either: clamp the body or move the parameters back into range"
            )
        return BandFactors(inner, reach, self.half_bandwidth, self.held)


class BandFactors:
    """Solves with the factors of a `BandMatrix`; valid until that matrix is used again."""

    def __init__(self, factors: np.ndarray, reach: np.ndarray, half_bandwidth: int, held: int) -> None:
        self._factors, self._reach = factors, reach
        self._half_bandwidth, self._held = half_bandwidth, held

    def solve(self, columns: np.ndarray, transposed: bool = False) -> np.ndarray:
        """Solution for each right-hand side [columns, nodes, 2]; held unknowns come back as zero."""
        out = np.zeros_like(columns)
        k, n, held = self._half_bandwidth, len(self._reach), self._held
        count = len(columns)
        padded = np.zeros((count, n + k))
        padded[:, :n] = columns.reshape(count, held + n)[:, held:]
        solve = banded_lu.solve_transposed if transposed else banded_lu.solve
        solve(self._factors, n, k, self._reach, padded)
        out.reshape(count, held + n)[:, held:] = padded[:, :n]
        return out
