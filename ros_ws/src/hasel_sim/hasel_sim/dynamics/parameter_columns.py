# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What every parameter of a model changes in the residual at a fixed motion: a column each, by compiled loops.

A parameter of an effect's law is differentiated as the law was recorded; everything else by central differences of only
what it changes: the solid, the whole system or the sites of a force, for a little more and a little less of it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hasel_sim.dynamics import column_loops
from hasel_sim.dynamics.column_loops import Columns
from hasel_sim.dynamics.system import System
from hasel_sim.laws.force_law import ForceLaw
from hasel_sim.laws.stress_law import StressLaw, places_of_stress
from hasel_sim.laws.tapes import BoundLaw, Tapes
from hasel_sim.mechanics.branches import Branches
from hasel_sim.mechanics.solid import Solid
from hasel_sim.mechanics.state import DriveState, Motion, State
from hasel_sim.simd import lane_tuple


class ResidualSlope:
    """Derivative of the residual by one parameter, of one lane or, by `beside`, of several."""

    @property
    def solids(self) -> tuple[tuple[Solid, np.ndarray], ...]:
        """The solids that it changes, with their factors [lanes] in the difference."""
        return ()

    @classmethod
    def beside(cls, each: Sequence[Any]) -> Any:
        """The same parameter of several bodies, one lane after the other."""
        return each[0]


class NoSlope(ResidualSlope):
    """A parameter that the mechanics does not see (it acts through the contraction or the observation)."""


class ContractionSlope(ResidualSlope):
    """The contraction that a muscle always has, whatever is commanded; muscle: its number."""

    def __init__(self, muscle: int) -> None:
        self.muscle = muscle


class LawSlope(ResidualSlope):
    """A parameter of one force or stress effect that changes its laws and not where they act.

    by_difference: the same of a force, should its sites move in another lane.
    """

    def __init__(
        self, laws: Sequence[ForceLaw | StressLaw], name: str, by_difference: "ForceSlope | None" = None
    ) -> None:
        self.laws, self.name, self.by_difference = laws, name, by_difference

    @classmethod
    def beside(cls, each: Sequence["LawSlope"]) -> "LawSlope":
        """The same parameter of several bodies, one lane after the other."""
        laws: list[ForceLaw | StressLaw] = []
        for beside in zip(*(slope.laws for slope in each), strict=True):
            if isinstance(beside[0], StressLaw):
                laws.append(StressLaw.beside(beside))
            else:
                laws += ForceLaw.beside(beside)
        return LawSlope(laws, each[0].name)


class _Difference(ResidualSlope):
    """Two of a kind, for a little more and a little less of a parameter, and the width between [lanes]."""

    def __init__(self, more: Any, less: Any, width: float | np.ndarray) -> None:
        self.more, self.less, self.width = more, less, np.atleast_1d(width)

    @classmethod
    def beside(cls, each: Sequence["_Difference"]) -> Any:
        """Those of several bodies, one lane after the other."""
        more, less = (cls._joined([getattr(slope, name) for slope in each]) for name in ("more", "less"))
        return cls(more, less, np.concatenate([slope.width for slope in each]))

    @staticmethod
    def _joined(each: Sequence[Any]) -> Any:
        return type(each[0]).beside(each)

    @property
    def signed(self) -> tuple[tuple[Any, np.ndarray], ...]:
        """Both, with their factors [lanes] in the difference."""
        return (self.more, 1.0 / self.width), (self.less, -1.0 / self.width)


class ForceSlope(_Difference):
    """A parameter that moves the sites of a force: its laws for a little more and a little less of it."""

    @staticmethod
    def _joined(each: Sequence[Sequence[ForceLaw]]) -> list[ForceLaw]:
        return [law for laws in zip(*each, strict=True) for law in ForceLaw.beside(laws)]


class SolidSlope(_Difference):
    """A parameter of the solid's constants, rest shape or branches; more, less: `Solid`."""

    @property
    def solids(self) -> tuple[tuple[Solid, np.ndarray], ...]:
        """Both."""
        return self.signed


class SystemSlope(_Difference):
    """A parameter that changes everything, such as the outline; more, less: `System`."""

    @property
    def solids(self) -> tuple[tuple[Solid, np.ndarray], ...]:
        """Those of both."""
        return tuple((system.solid, factor) for system, factor in self.signed)


def beside(each: Sequence[Any]) -> Any:
    """The same parameter of several bodies, one lane after the other, some of which it may not move the sites of."""
    if any(isinstance(slope, ForceSlope) for slope in each):
        each = [slope.by_difference if isinstance(slope, LawSlope) else slope for slope in each]
    return type(each[0]).beside(each)


_Steps = Sequence[tuple[np.ndarray, np.ndarray]]
"""Of every kind of step: how far into it forces balance [s], and its length [s], per lane."""


@dataclass(frozen=True)
class _Body:
    """One of the two of a central difference: its column, its solid, its system where all of that differs, and its
    factor [lanes] in the difference.
    """

    column: int
    solid: Solid
    system: System | None
    factor: np.ndarray

    @property
    def laws(self) -> list[ForceLaw | StressLaw]:
        """Those that differ from the system's own."""
        return [] if self.system is None else [*self.system.forces, *self.system.stresses]


class ResidualColumns:
    """Columns of a `System`'s parameters.

    contraction: what each changes in the contraction of the muscles at all times, [columns, 1 + muscles, lanes], 0
    first. Arrays over columns are [columns, nodes, 2, lanes].
    """

    def __init__(self, system: System, parameters: Sequence[ResidualSlope]) -> None:
        self._system, self.parameters, lanes = system, list(parameters), system.lanes
        self._lane, muscles = lane_tuple(lanes), system.muscles
        self.contraction = np.zeros((len(self.parameters), 1 + muscles, lanes))
        self._wanted: list[tuple[BoundLaw, Any]] = []
        laws: list[tuple[int, int, bool]] = []
        factors: list[np.ndarray] = []
        self._bodies: list[_Body] = []
        for column, parameter in enumerate(self.parameters):
            if isinstance(parameter, ContractionSlope):
                self.contraction[column, 1 + parameter.muscle] = 1.0
            for law, of, factor in _laws_of(parameter, lanes):
                laws.append((self._want(law, of), column, isinstance(law, ForceLaw)))
                factors.append(np.broadcast_to(factor, (1 + muscles, lanes)))
            for n, (solid, factor) in enumerate(parameter.solids):
                whole = parameter.signed[n][0] if isinstance(parameter, SystemSlope) else None
                self._bodies.append(_Body(column, solid, whole, factor))
        own: list[ForceLaw | StressLaw] = [*system.forces, *system.stresses]
        by_contraction = [
            (self._want(law, ("contraction", muscle)), 1 + muscle, isinstance(law, ForceLaw))
            for law in own
            for muscle in _looks_at(law, muscles)
        ]
        self._programs, self._ranges = self._laws_of_bodies()
        self._tapes = Tapes(self._wanted, lanes, muscles)
        self._laws = (
            np.array(laws, dtype=np.intp).reshape(-1, 3),
            np.array(factors).reshape(-1, 1 + muscles, lanes),
        )
        self._by_contraction = np.array(by_contraction, dtype=np.intp).reshape(-1, 3)
        shape, none = system.solid.areas.shape, np.zeros((1, 1, lanes))
        stress, history = (np.zeros((*shape, 3, lanes)) for _ in range(2))
        self._further, self._room = self._places(), (np.zeros(system.weight.shape), stress, history, none)
        self._fixed = self._fixed_of_bodies()
        self._known: dict[tuple[bytes, ...], Columns] = {}

    def __len__(self) -> int:
        return len(self.parameters)

    def _want(self, law: ForceLaw | StressLaw, of: Any) -> int:
        """The number of a program."""
        self._wanted.append((law, of))
        return len(self._wanted) - 1

    def _laws_of_bodies(self) -> tuple[np.ndarray, np.ndarray]:
        """Programs of the laws of all bodies, and where those of each begin and end."""
        programs: list[tuple[int, bool]] = []
        ranges: list[tuple[int, int]] = []
        for body in self._bodies:
            first = len(programs)
            programs += [(self._want(law, "value"), isinstance(law, ForceLaw)) for law in body.laws]
            ranges.append((first, len(programs)))
        pairs = (np.array(rows, dtype=np.intp).reshape(-1, 2) for rows in (programs, ranges))
        return next(pairs), next(pairs)

    def _places(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        solid = self._system.solid
        stressed = [law for law, _ in self._wanted if isinstance(law, StressLaw)]
        place, count = places_of_stress(len(solid.elements), stressed)
        shape = count, solid.areas.shape[1]
        return place, np.zeros((*shape, 4, self._system.lanes)), np.zeros((0, 1, 4, 4, self._system.lanes))

    def _fixed_of_bodies(
        self,
    ) -> tuple[
        np.ndarray,
        np.ndarray,
        tuple[np.ndarray, ...],
        np.ndarray,
        np.ndarray,
        np.ndarray,
        np.ndarray,
    ]:
        """What no kind of step changes: columns and programs, factors, shapes, masses, weights, moduli of C : E."""
        own, mass, weight = self._system.solid, self._system.mass.masses, self._system.weight
        nothing, lanes = (np.zeros_like(mass), np.zeros_like(weight)), self._system.lanes
        solids = [body.solid for body in self._bodies]
        inert = [
            nothing if b.system is None else (b.system.mass.masses, b.system.weight) for b in self._bodies
        ]
        columns = [[body.column] for body in self._bodies]
        only_stress = [[body.system is None and body.solid.same_shape(own)] for body in self._bodies]
        numbers = [np.array(n, dtype=np.intp).reshape(-1, 1) for n in (columns, only_stress)]
        factors = [np.broadcast_to(body.factor, (3, lanes)) for body in self._bodies]

        def stacked(each: list[np.ndarray], like: np.ndarray) -> np.ndarray:
            return np.ascontiguousarray(np.stack(each)) if each else np.zeros((0, *like.shape))

        shapes = tuple(
            stacked([getattr(solid, name) for solid in solids], getattr(own, name))
            for name in ("gradients", "areas", "stretch")
        )
        return (
            np.hstack([numbers[0], self._ranges, numbers[1]]),
            stacked(factors, np.zeros((3, lanes))),
            shapes,
            stacked([masses for masses, _ in inert], nothing[0]),
            stacked([weight for _, weight in inert], nothing[1]),
            stacked([solid.shear for solid in solids], own.shear),
            stacked([solid.linear_lame for solid in solids], own.linear_lame),
        )

    def table(self, steps: _Steps) -> Columns:
        """`columns` of `column_loops` for these kinds of step."""
        key = tuple(np.asarray(length, dtype=float).tobytes() for step in steps for length in step)
        if key not in self._known:
            self._known = dict([*self._known.items()][-7:])  # a run has few lengths of steps
            self._known[key] = self._tabulated(steps)
        return self._known[key]

    def _tabulated(self, steps: _Steps) -> Columns:
        which, factors, shapes, masses, weight, shear, lame = self._fixed
        own, lanes = self._system.solid, self._system.lanes
        solids = [body.solid for body in self._bodies]
        coefficients = np.zeros((len(solids), len(steps), *own.table(0.0).shape))
        branches = np.zeros((4, len(solids), len(steps), len(own.branches), lanes))
        for b, solid in enumerate(solids):
            for kind, (at, length) in enumerate(steps):
                coefficients[b, kind] = solid.table(at)
                if len(own.branches):
                    branches[:2, b, kind] = _to_balance(solid.branches, at)
                    branches[2:, b, kind] = solid.branches.factors(length) if np.any(length) else 0.0
        memory = *branches, shear, lame
        bodies = which, self._programs, factors, shapes, coefficients, masses, weight, memory
        return self._tapes.tables, self._laws, self._by_contraction, self._further, bodies, self._room

    def call(self, motion: Motion, drive: DriveState) -> None:
        """Call every law that runs as Python, before the compiled loops go on."""
        for program in range(len(self._wanted)):
            self._tapes.fill(program, motion, drive, self._system.solid.places)

    def at(
        self,
        motion: Motion,
        drive: DriveState,
        state: State | None,
        at: float | np.ndarray,
        load_factor: float = 1.0,
    ) -> np.ndarray:
        """Derivatives of the residual at one motion, zero at held nodes, under a share of all loads.

        state: that of the step's start, None where the branches have relaxed; at: how far into the step forces balance
        [s]; 0 for statics.
        """
        solid, lanes = self._system.solid, self._system.lanes
        out = np.zeros((len(self), *motion.position.shape))
        if not self._wanted and not self._bodies and not self.contraction.any():
            return out
        self.call(motion, drive)
        none = np.zeros((0, 1, 1, 3, lanes)), np.zeros((1, 1, 3, lanes))
        memory = none if state is None or state.branch is None else (state.branch, state.green)
        here = motion.fields, self._system.for_loops[0], drive.signals
        columns = self.table([(np.broadcast_to(at, lanes), np.zeros(lanes))])
        column_loops.add_residual_columns(columns, 0, *here, memory, float(load_factor), out, self._lane)
        if self.contraction.any():
            by_muscle = solid.contraction_force(solid.gradient(motion.position))
            out += np.einsum("cml,mndl->cndl", self.contraction[:, 1:], by_muscle)
            column_loops.add_laws_by_contraction(columns, *here, self.contraction, out, self._lane)
        return self._system.held_to_zero(out)


def _laws_of(parameter: ResidualSlope, lanes: int) -> list[tuple[ForceLaw | StressLaw, Any, np.ndarray]]:
    """Laws that a parameter changes, what of them, and the factors [lanes] of their forces."""
    if isinstance(parameter, LawSlope):
        return [(law, (("p", parameter.name), 0), np.ones(lanes)) for law in parameter.laws]
    if isinstance(parameter, ForceSlope):
        return [(law, "value", factor) for laws, factor in parameter.signed for law in laws]
    return []


def _looks_at(law: ForceLaw | StressLaw, muscles: int) -> range:
    """The muscles whose contraction a law is differentiated by: all, or the one that a point of a stress lies in."""
    if isinstance(law, ForceLaw):
        return range(muscles if "contraction" in law.effect.depends_on else 0)
    blind = law.laws is not None and not law.laws[0].program(("contraction", 0)).outputs
    return range(0 if blind or not law.concerns_muscles else 1)


def _to_balance(branches: Branches, at: np.ndarray) -> tuple[np.ndarray, np.ndarray] | np.ndarray:
    """What a time [s] leaves of the branches' stresses and gains; all of them at 0."""
    if np.any(at):
        return branches.factors(at)
    return np.stack([np.ones_like(branches.ratio), np.zeros_like(branches.ratio)])
