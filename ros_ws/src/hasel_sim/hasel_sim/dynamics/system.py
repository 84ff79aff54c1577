# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The mechanical system: its residual, all derivatives of it at one motion, and what its effects add to a step.

The residual is that of solid, inertia, loads and force effects.
"""

from collections.abc import Sequence
from copy import copy
from functools import cached_property

import numpy as np

from hasel_sim.laws.force_law import ForceLaw
from hasel_sim.laws.stress_law import StressLaw, places_of_stress
from hasel_sim.laws.tape_loops import add_slopes, respond
from hasel_sim.laws.tapes import BoundLaw, Tapes
from hasel_sim.mechanics import assembly, constitutive
from hasel_sim.mechanics.assembly import site_groups
from hasel_sim.mechanics.balance import Body
from hasel_sim.mechanics.banded import BandMatrix
from hasel_sim.mechanics.solid import Deformation, Mass, Solid
from hasel_sim.mechanics.state import DriveState, Memory, Motion, State
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
        self._last_deformation: Deformation | None = None
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

    @property
    def for_loops(self) -> Body:
        """`body` of the compiled loops, see `time_loop`."""
        solid = self.solid
        return (*solid.places, solid.muscle, solid.plane_stress), self.mass.masses, self.weight

    def band_matrix(self) -> BandMatrix:
        """Room for a matrix of its unknowns."""
        return BandMatrix(self.mesh.reach, 2 * self.held, self.lanes)

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

    def deformation(self, motion: Motion) -> Deformation:
        """Deformation gradient and its rate; kept for the last motion, which is asked for several times."""
        if self._last_deformation is None or self._last_deformation.motion is not motion:
            self._last_deformation = Deformation(self.solid, motion)
        return self._last_deformation

    def _first_piola(
        self, motion: Motion, drive: DriveState, memory: Memory
    ) -> tuple[np.ndarray, np.ndarray]:
        """Deformation gradient and first Piola stress; kept for the last motion likewise."""
        at = self.deformation(motion)
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
        constitutive.second_piola(F, P, out, lane_tuple(self.lanes))
        return out

    def held_to_zero(self, columns: np.ndarray) -> np.ndarray:
        """Set the held nodes of [columns, nodes, 2, lanes] to zero in place, and return it."""
        columns[:, : self.held] = 0.0
        return columns


class DeformedSystem(Deformation):
    """A `System` at one motion."""

    def __init__(self, system: System, motion: Motion) -> None:
        super().__init__(system.solid, motion)
        self.system = system

    def by_contraction(self, drive: DriveState) -> np.ndarray:
        """Derivative of the residual by the contraction of every muscle, [muscles, nodes, 2, lanes]."""
        out = self.system.solid.contraction_force(self.F)
        for law in self.system.stresses:
            if law.concerns_muscles:
                for muscle, slope in enumerate(law.contraction_slopes(self, drive)):
                    P = np.zeros_like(self.F)
                    P[law.elements] = slope
                    self.system.solid.add_force(P, out[muscle])
        for law in self.system.forces:
            law.add_contraction(out)
        return self.system.held_to_zero(out)


class Linearisation(DeformedSystem):
    """Derivatives of a `System`'s residual at one motion: as a band matrix, and along given directions."""

    def __init__(
        self, system: System, motion: Motion, elastic: np.ndarray, viscous: np.ndarray, load_factor: float
    ) -> None:
        super().__init__(system, motion)
        self.elastic, self.viscous, self._load_factor = elastic, viscous, load_factor

    def matrix(
        self, position: float | np.ndarray, velocity: float | np.ndarray, acceleration: float | np.ndarray
    ) -> BandMatrix:
        """position K + velocity C + acceleration M, weighted per lane."""
        lanes = self.system.lanes
        out = self.system.band_matrix()
        weights = np.empty((3, lanes))
        weights[0], weights[1], weights[2] = position, velocity, acceleration
        masses, places, lane = self.system.mass.masses, self.system.solid.places, lane_tuple(lanes)
        band = out.entries, out.diagonal
        assembly.scatter_matrix(self.elastic, self.viscous, masses, weights, *places, *band, lane)
        share = self._load_factor
        for law in self.system.forces:
            law.add_matrix(share * position, share * velocity, share * acceleration, *band)
        return out

    def along(self, shift: np.ndarray, rate: np.ndarray, acceleration: np.ndarray) -> np.ndarray:
        """Change of the residual along directions of the motion, all [columns, nodes, 2, lanes]."""
        if rate.shape[1:] != (*self.system.nodes.shape, self.system.lanes):
            raise ValueError(f"directions have the shape {rate.shape}; expected [columns, nodes, 2, lanes]")
        out = self.system.mass.product(acceleration)
        places, lane = self.system.solid.places, lane_tuple(self.system.lanes)
        assembly.scatter_directions(self.viscous, *places, np.ascontiguousarray(rate), out, lane)
        assembly.scatter_directions(self.elastic, *places, np.ascontiguousarray(shift), out, lane)
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
        transposed = np.empty_like(self.elastic)
        places, lane = self.system.solid.places, lane_tuple(self.system.lanes)
        for row, moduli in enumerate((self.elastic, self.viscous)):
            assembly.transpose_moduli(moduli, transposed, lane)
            assembly.scatter_directions(transposed, *places, weights[None], out[row : row + 1], lane)
        for law in self.system.forces:
            law.add_pulled_back(self._load_factor * weights, list(out))
        return self.system.held_to_zero(out)


def linearise(
    system: System, motion: Motion, drive: DriveState, memory: Memory, load_factor: float = 1.0
) -> Linearisation:
    """All derivatives of a system's residual by the motion, at this motion; valid until the next call."""
    at = system.deformation(motion)
    elastic, viscous = system.solid.moduli(at.F, at.rate, drive.contraction, memory.history, memory.step)
    for law in system.stresses:
        law.add_moduli(at, drive, elastic, viscous)
    for law in system.forces:
        law.linearise(motion, drive)
    return Linearisation(system, motion, elastic, viscous, load_factor)


class LawTable:
    """Forces and additional stresses of every effect, called at one motion, with their derivatives where wanted.

    terms: nodal forces out of balance [nodes, 2, lanes]; the sites of all force effects (their `SiteGroups`,
    derivatives by the value and by the tangent of the end-of-step acceleration [sites, 2, 2, lanes]); the place of
    every element among those with further stress or -1, and their stress [n, points, 4, lanes] and its derivative
    [n, points, 4, 4, lanes]. Empty where no effect acts; one at its null is not among the laws. by_rate: derivative of
    the further stress by the rate of the deformation [n, points, 4, 4, lanes] alone, of `linearise`. programs, tapes:
    what `tape_loops.respond` takes.
    """

    def __init__(self, system: System) -> None:
        self._system, solid, lanes = system, system.solid, system.lanes
        sites = [(law.sites, law.looks_along) for law in system.forces]
        slopes = np.zeros((2, sum(len(each.nodes) for each, _ in sites), 2, 2, lanes))
        further, count = places_of_stress(len(solid.elements), system.stresses)
        points = solid.areas.shape[1]
        stress, matrix, self.by_rate = (np.zeros((count, points, *n, lanes)) for n in ((4,), (4, 4), (4, 4)))
        self.terms = (
            np.zeros((*system.nodes.shape, lanes)),
            (site_groups(sites), slopes[0], slopes[1]),
            (further, stress, matrix),
        )
        self._laws: list[ForceLaw | StressLaw] = [*system.forces, *system.stresses]
        firsts = [0, *np.cumsum([law.points for law in system.forces])][: len(system.forces)]
        firsts += [-1] * len(system.stresses)
        rows = [(2 * n, 2 * n + 1, first) for n, first in enumerate(firsts)]
        self.programs = np.array(rows, dtype=np.intp).reshape(-1, 3)
        wanted: list[tuple[BoundLaw, str]] = [(law, of) for law in self._laws for of in ("value", "response")]
        self.tapes = Tapes(wanted, lanes, system.muscles)

    def __bool__(self) -> bool:
        """Whether there are any effects to call."""
        return bool(self._laws)

    @cached_property
    def as_python(self) -> bool:
        """Whether any of them runs as Python, and must be called before the compiled loops go on."""
        return any(law.laws is None for law in self._laws)

    def python_laws(self) -> dict[str, str]:
        """Names of effects that run as Python, with why they do."""
        as_python = [law for law in self._laws if law.laws is None]
        return {law.effect.source or law.effect.id: law.why_python for law in as_python}

    def call(self, motion: Motion, drive: DriveState, with_slopes: bool, exact: bool = False) -> None:
        """Call every effect that runs as Python once, with its derivatives where wanted."""
        for value, response, _ in self.programs.tolist():
            program = response if with_slopes else value
            self.tapes.fill(program, motion, drive, self._system.solid.places, exact)

    def linearise(self, at: DeformedSystem, drive: DriveState, weights: np.ndarray) -> None:
        """Differentiate every effect; terms as in `tape_loops.respond`, whose weights these are."""
        if not self:
            return
        self.call(at.motion, drive, with_slopes=True, exact=True)
        motion, lane = at.motion, lane_tuple(self._system.lanes)
        fields, places = motion.fields, self._system.solid.places
        tables = self.tapes.tables
        respond(tables, self.programs, True, fields, places, drive.signals, weights, self.terms, lane)
        _, (_, *sites), (further, _, _) = self.terms
        rate_alone = np.array([0.0, 1.0, 0.0])[:, None] * np.ones(self._system.lanes)
        self.by_rate[:] = 0.0
        for law, (_, program, _) in zip(self._laws, self.programs.tolist(), strict=True):
            if isinstance(law, ForceLaw):
                law.keep(self.tapes.rows(program))
                if "contraction" in law.effect.depends_on:
                    law.linearise(motion, drive)
            elif "rate" in law.moving:
                add_slopes(tables, program, -1, further, rate_alone, tuple(sites), self.by_rate, lane)

    def add_pulled_back(self, weights: np.ndarray, rate: np.ndarray, acceleration: np.ndarray) -> None:
        """Add to both [nodes, 2, lanes] the transposed derivatives of the forces out of balance times weights."""
        for law in self._system.forces:
            law.add_pulled_back(weights, (None, rate, acceleration))
