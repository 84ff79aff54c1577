"""The derivatives of a motion by parameters that are brought along with its steps, and the room that this takes.

With A the matrix of a step and s what the derivatives before the step change in its positions, one factorisation of A
serves the columns of all parameters (direct differentiation; e.g. Michaleris, Tortorelli and Vidal, Int. J. Numer.
Methods Eng. 37 (1994) 2471). They are exact to the tolerance of the steps.
"""

from collections.abc import Sequence

import numpy as np

from hasel_sim.mechanics.generalised_alpha import StepCoefficients
from hasel_sim.mechanics.motion import DriveState, Motion
from hasel_sim.mechanics.residual_columns import ResidualColumns
from hasel_sim.mechanics.residual_slopes import ResidualSlope
from hasel_sim.mechanics.state import StateSlopes
from hasel_sim.mechanics.system import System


class StepSlopes:
    """Columns of a `System`'s parameters, beside its steps.

    by_rate: room for the derivative of the further stress by the rate, see `LawTable`; more: nodes behind those of the
    mesh that a right-hand side has.
    """

    def __init__(
        self, system: System, parameters: Sequence[ResidualSlope], by_rate: np.ndarray, more: int
    ) -> None:
        self.columns = ResidualColumns(system, parameters)
        nodal, points, lanes, count = (
            system.weight.shape,
            system.solid.areas.shape,
            system.lanes,
            len(parameters),
        )
        branches = len(system.solid.branches)
        stress = (count if branches else 0, *points, 3, lanes)
        self._none = np.zeros((0, branches, *points, 3, lanes)), np.zeros((0, *points, 3, lanes))
        self._room = (
            (
                *(np.zeros(nodal) for _ in range(4)),
                np.zeros((stress[0], branches, *points, 3, lanes)),
                np.zeros(stress),
            ),
            tuple(np.zeros((count, *nodal)) for _ in range(3)),
            np.zeros((count, nodal[0] + more, 2, lanes)),
            np.zeros(stress),
            np.array([0.0, 1.0, 0.0])[:, None] * np.ones(lanes),
            by_rate,
        )

    def __len__(self) -> int:
        return len(self.columns)

    def plan(
        self, slopes: StateSlopes, by_contraction: np.ndarray, coefficients: Sequence[StepCoefficients]
    ) -> tuple:
        """What `march` takes of derivatives that are moved in place from now on.

        by_contraction: derivatives of the contraction at every step [steps, columns, muscles, lanes].
        """
        lanes = by_contraction.shape[-1]
        every = np.concatenate([np.zeros_like(by_contraction[:, :, :1]), by_contraction], axis=2)
        steps = [(np.broadcast_to(c.at, lanes), np.broadcast_to(c.step, lanes)) for c in coefficients]
        branch, green = self._none if slopes.branch is None else (slopes.branch, slopes.green)
        moving = slopes.position, slopes.velocity, slopes.acceleration, branch, green
        return moving, every + self.columns.contraction, self.columns.table(steps), self._room

    def call(self, motion: Motion, drive: DriveState) -> None:
        """Call every law of the columns that runs as Python, before the compiled loops go on."""
        self.columns.call(motion, drive)
