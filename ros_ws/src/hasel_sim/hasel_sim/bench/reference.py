"""What a time step is measured against: LAPACK solving a linear system of the same size.

Both are slow together on a slow or busy machine, so their ratio says more of the code than seconds do.
"""

from collections.abc import Callable

import numpy as np
from scipy.linalg import lapack

from hasel_sim.model import Model
from hasel_sim.model_mesh import model_mesh


def band_solutions(model: Model, times: int) -> Callable[[], None]:
    """Work: solve, so many times, a banded system of the model's unknowns and bandwidth, with pivoting (dgbsv)."""
    reach = model_mesh(model).reach
    unknowns, half_bandwidth = len(reach), int(reach.max())
    random = np.random.default_rng(0)
    band = random.standard_normal((3 * half_bandwidth + 1, unknowns))
    band[2 * half_bandwidth] += 100.0
    right_hand_side = random.standard_normal(unknowns)

    def work() -> None:
        for _ in range(times):
            lapack.dgbsv(half_bandwidth, half_bandwidth, band, right_hand_side)

    return work
