"""The exact matrix of a step that was made, of which all its derivatives are solved for."""

import numpy as np

from hasel_sim.mechanics.banded import BandMatrix, singular_matrix
from hasel_sim.mechanics.law_table import LawTable
from hasel_sim.mechanics.linearisation import StrainedSystem
from hasel_sim.mechanics.part import Part
from hasel_sim.mechanics.system import System


class StepMatrix:
    """Room for the matrix, and what the compiled calls of `slope_system` take of a step.

    laws: the system's effects, differentiated at the step that `at_step` was called for; matrix: as in `march`; more:
    nodes behind those of the mesh that a right-hand side has.
    """

    def __init__(self, system: System) -> None:
        self.system, self.laws = system, LawTable(system)
        solid, matrix = system.solid, BandMatrix(system.mesh.reach, 2 * system.held, system.lanes)
        self._body = (*solid.places, solid.muscle, solid.plane_stress), system.mass.masses, system.weight
        shape = matrix.diagonal, matrix.half_bandwidth, matrix.held
        self.matrix = matrix.entries, matrix.reach, shape, np.zeros(1, dtype=bool)
        self._found = np.empty(system.weight.shape), np.empty((*solid.areas.shape, 3, system.lanes))
        self.more = matrix.half_bandwidth + 4

    def at_step(self, part: Part, at: StrainedSystem, transposed: bool = False) -> tuple:
        """Motion, weights of the matrix, body, drive, laws, room for a residual and a stress, matrix.

        at: the system at the step's motion; transposed: the derivative of the further stress by the rate.
        """
        motion, drive, c, solid = part.motion, part.drive, part.coefficients, self.system.solid
        history = self.system.memory(part.before, c.at).history
        self.laws.linearise(at, drive, c.matrix_weights)
        _, sites, further = self.laws.terms
        by_rate = self.laws.by_rate
        if transposed:
            by_rate = np.ascontiguousarray(by_rate.swapaxes(2, 3))
        return (
            (motion.position, motion.velocity, motion.acceleration),
            c.matrix_weights,
            self._body,
            (solid.table(c.at), drive.signals, solid.no_history if history is None else history),
            (sites, further, by_rate),
            self._found,
            self.matrix,
        )

    @staticmethod
    def check(bad: np.ndarray) -> None:
        """Raise SimulationError where the matrix of every lane is singular; bad [lanes]: see `banded_lu.factorise`."""
        if (bad >= 0).all():
            raise singular_matrix(bad[0])
