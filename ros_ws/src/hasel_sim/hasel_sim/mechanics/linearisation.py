"""The derivatives of a mechanical system's residual at one motion."""

import numpy as np

from hasel_sim.mechanics import assembly
from hasel_sim.mechanics.banded import BandMatrix
from hasel_sim.mechanics.motion import DriveState, Memory, Motion
from hasel_sim.mechanics.strained import Strained
from hasel_sim.mechanics.system import System
from hasel_sim.simd import lane_tuple


class StrainedSystem(Strained):
    """A `System` at one motion."""

    def __init__(self, system: System, motion: Motion) -> None:
        super().__init__(system.solid, motion)
        self.system = system

    def by_contraction(self, drive: DriveState) -> np.ndarray:
        """Derivative of the residual by the contraction of every muscle, [muscles, nodes, 2, lanes]."""
        out = self.system.solid.contraction_force(self.F)
        self.add_laws_by_contraction(drive, out)
        return self.system.held_to_zero(out)

    def add_laws_by_contraction(self, drive: DriveState, out: np.ndarray) -> None:
        """Add what effects have of it to out [muscles, nodes, 2, lanes]."""
        for law in self.system.stresses:
            if law.concerns_muscles:
                for muscle, slope in enumerate(law.contraction_slopes(self, drive)):
                    P = np.zeros_like(self.F)
                    P[law.elements] = slope
                    self.system.solid.add_force(P, out[muscle])
        for law in self.system.forces:
            law.add_contraction(out)


class Linearisation(StrainedSystem):
    """Derivatives of a `System`'s residual at one motion: as a band matrix, and along given directions."""

    def __init__(
        self,
        system: System,
        motion: Motion,
        elastic: np.ndarray,
        viscous: np.ndarray,
        load_factor: float = 1.0,
    ) -> None:
        super().__init__(system, motion)
        self.elastic, self.viscous, self._load_factor = elastic, viscous, load_factor

    def matrix(
        self,
        position: float | np.ndarray,
        velocity: float | np.ndarray,
        acceleration: float | np.ndarray,
    ) -> BandMatrix:
        """position K + velocity C + acceleration M, weighted per lane."""
        lanes = self.system.lanes
        out = BandMatrix(self.system.mesh.reach, 2 * self.system.held, lanes)
        weights = np.empty((3, lanes))
        weights[0], weights[1], weights[2] = position, velocity, acceleration
        assembly.scatter_matrix(
            self.elastic,
            self.viscous,
            self.system.mass.masses,
            weights,
            *self.system.solid.places,
            out.entries,
            out.diagonal,
            lane_tuple(lanes),
        )
        share = self._load_factor
        for law in self.system.forces:
            law.add_matrix(
                share * position, share * velocity, share * acceleration, out.entries, out.diagonal
            )
        return out

    def along(
        self,
        shift: np.ndarray | None,
        rate: np.ndarray,
        acceleration: np.ndarray,
        stress: np.ndarray | None = None,
    ) -> np.ndarray:
        """Change of the residual along directions of the motion, all [columns, nodes, 2, lanes].

        shift: None for no change of the positions; stress: a further change of the first Piola stress,
        [columns, elements, points, 4, lanes].
        """
        if rate.shape[1:] != (*self.system.nodes.shape, self.system.lanes):
            raise ValueError(f"directions have the shape {rate.shape}; expected [columns, nodes, 2, lanes]")
        out = self.system.mass.product(acceleration)
        none = np.empty((0, *self.F.shape))
        further = none if stress is None else stress
        places, lane = self.system.solid.places, lane_tuple(self.system.lanes)
        assembly.scatter_directions(self.viscous, further, *places, np.ascontiguousarray(rate), out, lane)
        if shift is None:
            shift = np.zeros_like(rate)
        else:
            assembly.scatter_directions(self.elastic, none, *places, np.ascontiguousarray(shift), out, lane)
        share = self._load_factor
        for law in self.system.forces:
            law.add_directions(share * shift, share * rate, share * acceleration, out)
        return self.system.held_to_zero(out)

    def force_along(self, shift: np.ndarray) -> np.ndarray:
        """How the surroundings resist displacements [columns, nodes, 2, lanes]: less what changes in their forces."""
        out, still = np.zeros_like(shift), np.zeros_like(shift)
        for law in self.system.forces:
            law.add_directions(self._load_factor * shift, still, still, out)
        return out

    def pulled_back(self, weights: np.ndarray) -> np.ndarray:
        """Transposed derivatives by position, velocity and acceleration times weights [nodes, 2, lanes], [3, ...]."""
        nothing = np.zeros_like(weights)
        out = np.stack([nothing, nothing, self.system.mass.product(weights[None])[0]])
        none, transposed = np.empty((0, *self.F.shape)), np.empty_like(self.elastic)
        places, lane = self.system.solid.places, lane_tuple(self.system.lanes)
        for row, moduli in enumerate((self.elastic, self.viscous)):
            assembly.transpose_moduli(moduli, transposed, lane)
            assembly.scatter_directions(transposed, none, *places, weights[None], out[row : row + 1], lane)
        for law in self.system.forces:
            law.add_pulled_back(self._load_factor * weights, list(out))
        return self.system.held_to_zero(out)


def linearise(
    system: System, motion: Motion, drive: DriveState, memory: Memory, load_factor: float = 1.0
) -> Linearisation:
    """All derivatives of a system's residual by the motion, at this motion; valid until the next call."""
    at = system.strain(motion)
    elastic, viscous = system.solid.moduli(at.F, at.rate, drive.contraction, memory.history, memory.step)
    for law in system.stresses:
        law.add_moduli(at, drive, elastic, viscous)
    for law in system.forces:
        law.linearise(motion, drive)
    return Linearisation(system, motion, elastic, viscous, load_factor)
