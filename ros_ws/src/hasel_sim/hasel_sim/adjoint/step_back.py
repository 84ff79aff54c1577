"""Back through one step: what weights after it mean for the motion at which its forces balance."""

import numpy as np

from hasel_sim.mechanics import slope_system
from hasel_sim.mechanics.linearisation import StrainedSystem
from hasel_sim.mechanics.part import Part
from hasel_sim.mechanics.step_matrix import StepMatrix
from hasel_sim.mechanics.system import System
from hasel_sim.simd import lane_tuple


class StepBack:
    """The multiplier of a step, and its products with the transposed derivatives of the residual.

    With A = x K + v C + a M the matrix of the step and g the weights that reach its end-of-step acceleration, the
    multiplier solves A^T mu = -g, so that K^T mu = -(g + v C^T mu + a M^T mu) / x needs no stiffness.
    """

    def __init__(self, system: System) -> None:
        self.system, self._matrix = system, StepMatrix(system)
        nodal, points, muscles = system.weight.shape, system.solid.areas.shape, system.solid.muscle.max()
        self._weights = np.empty((1, nodal[0] + self._matrix.more, 2, system.lanes))
        self._moved = np.zeros((2, *nodal)), np.zeros((2, *nodal))
        self._pulled = np.empty((2, *nodal))
        self._no_contraction = np.zeros((2, 1 + muscles, system.lanes))
        self._no_stress = np.empty((0, *points, 3, system.lanes))

    def pull(
        self, part: Part, at: StrainedSystem, reached: np.ndarray
    ) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """The multiplier [nodes, 2, lanes], and with it the residual's derivatives by position, velocity, acceleration.

        at: the system at the step's motion; reached: weights of the end-of-step acceleration. Raises SimulationError
        where the matrix of the step is singular.
        """
        nodes, c, bad = len(reached), part.coefficients, np.full(self.system.lanes, -1)
        self._weights[0, :nodes] = -reached
        slope_system.pull_back(
            self._matrix.at_step(part, at, transposed=True),
            self._weights,
            self._moved,
            self._no_contraction,
            self._no_stress,
            self._pulled,
            bad,
            lane_tuple(self.system.lanes),
        )
        self._matrix.check(bad)
        multiplier = self._weights[0, :nodes].copy()
        velocity, acceleration = self._pulled.copy()
        self._matrix.laws.add_pulled_back(multiplier, velocity, acceleration)
        position = -(reached + c.velocity * velocity + c.acceleration * acceleration) / c.position
        for by in (position, velocity, acceleration):
            by[: self.system.held] = 0.0
        return multiplier, (position, velocity, acceleration)
