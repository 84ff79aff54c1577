"""The mechanical system: solid, inertia, loads and force effects, as one residual."""

from collections.abc import Sequence
from copy import copy

import numpy as np

from hasel_sim.mechanics import strain
from hasel_sim.mechanics.force_law import ForceLaw
from hasel_sim.mechanics.inertia import Mass
from hasel_sim.mechanics.motion import DriveState, Memory, Motion
from hasel_sim.mechanics.solid import Solid
from hasel_sim.mechanics.state import State
from hasel_sim.mechanics.strained import Strained
from hasel_sim.mechanics.stress_law import StressLaw
from hasel_sim.mesh.mesh import Mesh
from hasel_sim.simd import lane_tuple


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
        muscles: int = 2,
    ) -> None:
        self.mesh, self.nodes, self.solid, self.muscles = mesh, nodes, solid, muscles
        self.mass = mass
        self.forces, self.stresses = forces, stresses
        self.weight = mass.product(np.broadcast_to(gravity[:, None], (1, *nodes.shape, 1)))[0]
        self.held = len(mesh.clamped)
        self._forget()

    def _forget(self) -> None:
        self._last_strain: Strained | None = None
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

    def memory(self, state: State, at: float | np.ndarray = 0.0) -> Memory:
        """What the branches carry from a state, in which a step starts, to `at` [s] into it."""
        if state.branch is None:
            return Memory()
        return Memory(self.solid.branches.history(state.branch, state.green, at), at)

    def strain(self, motion: Motion) -> Strained:
        """Deformation gradient and its rate; kept for the last motion, which is asked for several times."""
        if self._last_strain is None or self._last_strain.motion is not motion:
            self._last_strain = Strained(self.solid, motion)
        return self._last_strain

    def _first_piola(
        self, motion: Motion, drive: DriveState, memory: Memory
    ) -> tuple[np.ndarray, np.ndarray]:
        """Deformation gradient and first Piola stress; kept for the last motion likewise."""
        at = self.strain(motion)
        last = self._last_stress
        if last is None or last[0] is not motion or last[1] is not drive or last[2] is not memory:
            P = self.solid.stress(at.F, at.rate, drive.contraction, memory.history, memory.step)
            for law in self.stresses:
                P[law.elements] += law.stress(at, drive)
            self._last_stress = motion, drive, memory, P
        return at.F, self._last_stress[3]

    def second_piola(self, motion: Motion, drive: DriveState, memory: Memory) -> np.ndarray:
        """Second Piola stress [Pa] (xx, yy, xy) at the Gauss points, [elements, points, 3, lanes]."""
        F, P = self._first_piola(motion, drive, memory)
        out = np.empty((*P.shape[:2], 3, self.lanes))
        strain.second_piola(F, P, out, lane_tuple(self.lanes))
        return out

    def held_to_zero(self, columns: np.ndarray) -> np.ndarray:
        """Set the held nodes of [columns, nodes, 2, lanes] to zero in place, and return it."""
        columns[:, : self.held] = 0.0
        return columns
