"""The mechanical system: solid, inertia, loads and force effects, as one residual with its derivatives."""

from collections.abc import Sequence
from copy import copy
from functools import cached_property

import numpy as np

from hasel_sim.mechanics import compiled
from hasel_sim.mechanics.banded import BandMatrix
from hasel_sim.mechanics.force_law import ForceLaw
from hasel_sim.mechanics.inertia import Mass
from hasel_sim.mechanics.motion import DriveState, Memory, Motion
from hasel_sim.mechanics.simd import lane_tuple
from hasel_sim.mechanics.solid import Solid
from hasel_sim.mechanics.stress_law import StressLaw
from hasel_sim.mesh.mesh import Mesh


class System:
    """Residual M a + internal - external and its derivatives; held nodes come first and never move.

    Of one lane; more by `beside`. Nodal vectors are [nodes, 2, lanes], but `nodes`, the reference positions [nodes, 2].
    """

    def __init__(
        self,
        mesh: Mesh,
        nodes: np.ndarray,
        solid: Solid,
        mass: Mass,
        gravity: np.ndarray,
        forces: list[ForceLaw],
        stresses: list[StressLaw],
    ) -> None:
        self.mesh, self.nodes, self.solid = mesh, nodes, solid
        self.mass = mass
        self.forces, self.stresses = forces, stresses
        self.weight = mass.product(np.broadcast_to(gravity[:, None], (1, *nodes.shape, 1)))[0]
        self.held = len(mesh.clamped)
        self._forget()

    def _forget(self) -> None:
        self._last_strain: tuple[Motion, np.ndarray, np.ndarray] | None = None
        self._last_stress: tuple[Motion, DriveState, Memory, np.ndarray] | None = None

    @staticmethod
    def beside(each: Sequence["System"]) -> "System":
        """Several bodies with one mesh and the same effects, one lane after the other."""
        out = copy(each[0])
        out.solid, out.mass = Solid.beside([s.solid for s in each]), Mass.beside([s.mass for s in each])
        out.weight = np.concatenate([system.weight for system in each], axis=-1)
        out.forces = [
            law for laws in zip(*(s.forces for s in each), strict=True) for law in ForceLaw.beside(laws)
        ]
        out.stresses = [StressLaw.beside(laws) for laws in zip(*(s.stresses for s in each), strict=True)]
        out._forget()
        return out

    @property
    def lanes(self) -> int:
        """How many bodies move side by side."""
        return self.weight.shape[-1]

    def residual(
        self, motion: Motion, drive: DriveState, memory: Memory, load_factor: float = 1.0
    ) -> np.ndarray:
        """Out-of-balance nodal force [N per m depth], [nodes, 2, lanes]; zero at held nodes."""
        out = self.mass.product(motion.acceleration[None])[0]
        out -= load_factor * self.weight
        self.solid.add_force(self._first_piola(motion, drive, memory)[1], out)
        for law in self.forces:
            law.add_force(motion, drive, out, -load_factor)
        out[: self.held] = 0.0
        return out

    def strain(self, motion: Motion) -> tuple[np.ndarray, np.ndarray]:
        """Deformation gradient and its rate; kept for the last motion, which is asked for several times."""
        if self._last_strain is None or self._last_strain[0] is not motion:
            F, rate = self.solid.gradient(motion.position), self.solid.gradient(motion.velocity)
            self._last_strain = motion, F, rate
        return self._last_strain[1:]

    def _first_piola(
        self, motion: Motion, drive: DriveState, memory: Memory
    ) -> tuple[np.ndarray, np.ndarray]:
        """Deformation gradient and first Piola stress; kept for the last motion likewise."""
        F, rate = self.strain(motion)
        last = self._last_stress
        if last is None or last[0] is not motion or last[1] is not drive or last[2] is not memory:
            P = self.solid.stress(F, rate, drive.contraction, memory.history, memory.step)
            for law in self.stresses:
                P[law.elements] += law.stress(F, rate, drive)
            self._last_stress = motion, drive, memory, P
        return F, self._last_stress[3]

    def second_piola(self, motion: Motion, drive: DriveState, memory: Memory) -> np.ndarray:
        """Second Piola stress [Pa] (xx, yy, xy) at the Gauss points, [elements, points, 3, lanes]."""
        F, P = self._first_piola(motion, drive, memory)
        out = np.empty((*P.shape[:2], 3, self.lanes))
        compiled.second_piola(F, P, out, lane_tuple(self.lanes))
        return out

    def linearise(
        self, motion: Motion, drive: DriveState, memory: Memory, load_factor: float = 1.0
    ) -> "Linearisation":
        """All derivatives of the residual by the motion, at this motion; valid until the next call."""
        F, rate = self.strain(motion)
        elastic, viscous = self.solid.moduli(F, rate, drive.contraction, memory.history, memory.step)
        for law in self.stresses:
            law.add_moduli(F, rate, drive, elastic, viscous)
        for law in self.forces:
            law.linearise(motion, drive)
        return Linearisation(self, motion, elastic, viscous, load_factor)

    def held_to_zero(self, columns: np.ndarray) -> np.ndarray:
        """Set the held nodes of [columns, nodes, 2, lanes] to zero in place, and return it."""
        columns[:, : self.held] = 0.0
        return columns


class Strained:
    """A `System` at one motion: F and its rate [elements, points, 4, lanes], found when asked for."""

    def __init__(self, system: System, motion: Motion) -> None:
        self.system, self.motion = system, motion

    @cached_property
    def F(self) -> np.ndarray:
        """Deformation gradient [1]."""
        return self.system.strain(self.motion)[0]

    @cached_property
    def rate(self) -> np.ndarray:
        """Its rate [1/s]."""
        return self.system.strain(self.motion)[1]

    def by_contraction(self, drive: DriveState) -> np.ndarray:
        """Derivative of the residual by the contraction of every muscle, [muscles, nodes, 2, lanes]."""
        out = self.system.solid.contraction_force(self.F)
        self.add_laws_by_contraction(drive, out)
        return self.system.held_to_zero(out)

    def add_laws_by_contraction(self, drive: DriveState, out: np.ndarray) -> None:
        """Add what effects have of it to out [muscles, nodes, 2, lanes]."""
        for law in self.system.stresses:
            if law.concerns_muscles:
                for muscle, slope in enumerate(law.contraction_slopes(self.F, self.rate, drive)):
                    P = np.zeros_like(self.F)
                    P[law.elements] = slope
                    self.system.solid.add_force(P, out[muscle])
        for law in self.system.forces:
            law.add_contraction(out)


class Linearisation(Strained):
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
        self.F, self.rate = system.strain(motion)
        self.elastic, self.viscous, self._load_factor = elastic, viscous, load_factor

    def matrix(
        self,
        position: float | np.ndarray,
        velocity: float | np.ndarray,
        acceleration: float | np.ndarray,
        out: BandMatrix | None = None,
    ) -> BandMatrix:
        """position K + velocity C + acceleration M, weighted per lane; into `out`, whose factors are then lost."""
        lanes = self.system.lanes
        if out is None:
            out = BandMatrix(self.system.mesh.reach, 2 * self.system.held, lanes)
        else:
            out.clear()
        weights = np.empty((3, lanes))
        weights[0], weights[1], weights[2] = position, velocity, acceleration
        compiled.scatter_matrix(
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
        compiled.scatter_directions(self.viscous, further, *places, np.ascontiguousarray(rate), out, lane)
        if shift is None:
            shift = np.zeros_like(rate)
        else:
            compiled.scatter_directions(self.elastic, none, *places, np.ascontiguousarray(shift), out, lane)
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
            compiled.transpose_moduli(moduli, transposed, lane)
            compiled.scatter_directions(transposed, none, *places, weights[None], out[row : row + 1], lane)
        for law in self.system.forces:
            law.add_pulled_back(self._load_factor * weights, out)
        return self.system.held_to_zero(out)
