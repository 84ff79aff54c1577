"""A narrow-banded matrix in LAPACK's general band storage and its LU factors."""

import numpy as np
from scipy.linalg import lapack

from hasel_sim.errors import SimulationError


class BandMatrix:
    """Entry (i, j) is stored at [2 k + i - j, j] with k the half bandwidth, so that `factorise` works in place.

    The first `held` unknowns are fixed at zero: solutions leave them out.
    """

    def __init__(self, unknowns: int, half_bandwidth: int, held: int = 0) -> None:
        self.half_bandwidth = half_bandwidth
        self.diagonal = 2 * half_bandwidth
        self.held = held
        self.entries = np.zeros((3 * half_bandwidth + 1, unknowns), order="F")

    def set_to(self, other: "BandMatrix", factor: float) -> None:
        """Overwrite with factor times another matrix of the same shape."""
        np.multiply(other.entries, factor, out=self.entries)

    def factorise(self) -> "BandFactors":
        """LU factors with partial pivoting (dgbtrf); the matrix itself is used up.

        Raises SimulationError when it is singular.
        """
        k = self.half_bandwidth
        factors, pivots, info = lapack.dgbtrf(self.entries[:, self.held :], k, k, overwrite_ab=1)
        if info != 0:
            raise SimulationError(
                f"the tangent matrix is singular (unknown {info}); a body free to move has no static equilibrium, "
                "and extreme parameters have none either: clamp the body or move the parameters back into range"
            )
        return BandFactors(factors, pivots, k, self.held)


class BandFactors:
    """Solves with the factors of a `BandMatrix`."""

    def __init__(self, factors: np.ndarray, pivots: np.ndarray, half_bandwidth: int, held: int) -> None:
        self._factors, self._pivots = factors, pivots
        self._half_bandwidth, self._held = half_bandwidth, held

    def solve(self, columns: np.ndarray, transposed: bool = False) -> np.ndarray:
        """Solution for each right-hand side [columns, nodes, 2]; held unknowns come back as zero."""
        out = np.zeros_like(columns)
        if len(columns) == 0:
            return out
        k, flat = self._half_bandwidth, columns.reshape(len(columns), -1)
        right = np.array(flat[:, self._held :].T, order="F")
        solution, _ = lapack.dgbtrs(
            self._factors, k, k, right, self._pivots, trans=1 if transposed else 0, overwrite_b=1
        )
        out.reshape(len(columns), -1)[:, self._held :] = solution.T
        return out
