"""One correction of Newton's method in all lanes, in as few calls of compiled code as the effects in a model allow."""

import numpy as np
from numba import njit

from hasel_sim.mechanics.banded import BandFactors, BandMatrix
from hasel_sim.mechanics.compiled import (
    clear_band,
    combine,
    deformation,
    exchange_initial_stress,
    first_piola,
    mass_product,
    moduli,
    scatter_matrix,
    scatter_stress,
    second_piola,
)
from hasel_sim.mechanics.generalised_alpha import StepCoefficients
from hasel_sim.mechanics.motion import DriveState, Memory, Motion
from hasel_sim.mechanics.simd import lane_tuple
from hasel_sim.mechanics.state import State
from hasel_sim.mechanics.system import System


@njit(cache=True, fastmath=True, error_model="numpy")
def _stressed(before, new, weights, solid, table, contraction, history, at, strain, lane):
    """Motion at the balance, deformation gradient with its rate, and first Piola stress."""
    elements, gradients, _, stretch, muscle, plane_stress = solid
    combine(before[0], before[1], before[2], new, weights, at[0], at[1], at[2], lane)
    deformation(at[0], elements, gradients, stretch, strain[0], lane)
    deformation(at[1], elements, gradients, stretch, strain[1], lane)
    first_piola(strain[0], strain[1], table, muscle, contraction, history, plane_stress, strain[2], lane)


@njit(cache=True, fastmath=True, error_model="numpy")
def _out_of_balance(acceleration, P, solid, masses, weight, residual, lane):
    elements, gradients, areas, stretch, _, _ = solid
    residual[:] = 0.0
    mass_product(masses, elements, acceleration, residual, lane)
    residual[0] -= weight
    scatter_stress(P, elements, gradients, areas, stretch, residual[0], lane)


@njit(cache=True, fastmath=True, error_model="numpy")
def _derived(strain, solid, table, contraction, history, expected, stress, elastic, viscous, lane):
    """Moduli; with `expected`, the second Piola stress of the last balance, in place of the one found."""
    _, _, _, _, muscle, plane_stress = solid
    F, rate, P = strain
    moduli(F, rate, table, muscle, contraction, history, plane_stress, elastic, viscous, lane)
    if len(expected) > 0:
        second_piola(F, P, stress, lane)
        exchange_initial_stress(elastic, stress, expected, lane)


@njit(cache=True, fastmath=True, error_model="numpy")
def _assembled(elastic, viscous, masses, weights, solid, band, reach, diagonal, lane):
    elements, gradients, areas, stretch, _, _ = solid
    clear_band(band, reach, diagonal)
    scatter_matrix(
        elastic, viscous, masses, weights, elements, gradients, areas, stretch, band, diagonal, lane
    )


class Newton:
    """Corrections of the end-of-step acceleration of a `System`; arrays are kept from one to the next."""

    def __init__(self, system: System) -> None:
        self.system, solid = system, system.solid
        lanes, points = system.lanes, solid.areas.shape
        nodal = (*system.nodes.shape, lanes)
        self._lane = lane_tuple(lanes)
        self._motion = np.empty(nodal), np.empty(nodal), np.empty(nodal)
        self._strain = tuple(np.empty((*points, 4, lanes)) for _ in range(3))
        self._residual, self._stress = np.empty((1, *nodal)), np.empty((*points, 3, lanes))
        self._solid = *solid.places, solid.muscle, solid.plane_stress
        self._matrix = BandMatrix(system.mesh.reach, 2 * system.held, lanes)
        self._factors: BandFactors | None = None
        self._none = np.zeros((0, *points[1:], 3, lanes))
        self._at_rest = np.zeros((1, lanes))

    def begin(self, state: State, drive: DriveState, c: StepCoefficients, memory: Memory) -> None:
        """Take up a step."""
        self._before = state.position, state.velocity, state.acceleration
        self._drive, self._c, self._memory = drive, c, memory
        solid = self.system.solid
        self._table = solid.table(memory.step)
        self._history = solid.no_history if memory.history is None else memory.history
        self._contraction = np.concatenate([self._at_rest, drive.contraction])

    def evaluate(self, acceleration: np.ndarray) -> Motion:
        """Go to an acceleration: motion, strain and stress, and the residual."""
        _stressed(
            self._before,
            acceleration,
            self._c.to_balance,
            self._solid,
            self._table,
            self._contraction,
            self._history,
            self._motion,
            self._strain,
            self._lane,
        )
        system, motion = self.system, Motion(*self._motion)
        F, rate, P = self._strain
        for law in system.stresses:
            P[law.elements] += law.stress(F, rate, self._drive)
        return motion

    def correction(
        self, motion: Motion, fresh: bool, expected: np.ndarray | None
    ) -> tuple[np.ndarray, np.ndarray]:
        """The correction [nodes, 2, lanes] at the motion last evaluated, and the lanes whose matrix is singular.

        fresh: with a matrix of this motion, with the stress expected in place of the one found where given; otherwise
        with the last. Raises SimulationError when all are singular.
        """
        system, residual = self.system, self._residual
        masses, weight = system.mass.masses, system.weight
        acceleration = self._motion[2][None]
        _out_of_balance(acceleration, self._strain[2], self._solid, masses, weight, residual, self._lane)
        for law in system.forces:
            law.add_force(motion, self._drive, residual[0], -1.0)
        residual[0, : system.held] = 0.0
        if fresh:
            self._factorise(motion, expected)
        return self._factors.solve(residual)[0], self._factors.singular

    def _factorise(self, motion: Motion, expected: np.ndarray | None) -> None:
        system, c = self.system, self._c
        elastic, viscous = system.solid.kept_moduli
        _derived(
            self._strain,
            self._solid,
            self._table,
            self._contraction,
            self._history,
            self._none if expected is None else expected,
            self._stress,
            elastic,
            viscous,
            self._lane,
        )
        F, rate, _ = self._strain
        for law in system.stresses:
            law.add_moduli(F, rate, self._drive, elastic, viscous)
        matrix = self._matrix
        matrix.wipe()
        _assembled(
            elastic,
            viscous,
            system.mass.masses,
            c.matrix_weights,
            self._solid,
            matrix.entries,
            matrix.reach,
            matrix.diagonal,
            self._lane,
        )
        for law in system.forces:
            law.linearise(motion, self._drive)
            law.add_matrix(c.position, c.velocity, c.acceleration, matrix.entries, matrix.diagonal)
        self._factors = matrix.factorise()

    def second_piola(self) -> np.ndarray:
        """Second Piola stress [Pa] at the motion last evaluated, in an array of its own."""
        F, _, P = self._strain
        out = np.empty_like(self._stress)
        second_piola(F, P, out, self._lane)
        return out
