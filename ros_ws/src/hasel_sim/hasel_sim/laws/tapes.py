# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Laws bound to their points, and their programs side by side with what they need, as the compiled loop takes them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from hasel_sim.effects.base import ForceEffect, MaterialEffect, Surroundings, guarded
from hasel_sim.laws import tape_loops as loops
from hasel_sim.laws.program import WIDTH
from hasel_sim.laws.python_calls import ALONE, Copies, Groups, around, by_group, grouped, one_by_one
from hasel_sim.laws.recording import OF_THE_SITES, Law, NotTraceableError, alike
from hasel_sim.mechanics.state import DriveState, Motion
from hasel_sim.mesh.mesh import Places
from hasel_sim.simd import lane_tuple

_SOURCES = {name: source for source, name in enumerate((*OF_THE_SITES, "deformation", "rate"))}
"""Where an input comes from, as `tape_loops` counts."""

_CONTRACTION_DIFFERENCE = 1e-6

Rows = Callable[[str], np.ndarray]
"""What moves at the points of a law, by name, [copies, lanes, points, k]."""


class BoundLaw:
    """The law of an effect at its points, in all lanes.

    method: of the effect; k: how many numbers it gives at a point; points: how many; per: nodes of a site, or points of
    an element; differences: steps of the differences by what it may depend on; numbers, reals: of the sites (their
    nodes; shape, slope and weight) or of the elements (their numbers, then the muscle of every point; nothing).
    moving: see `Law`; laws: as recorded, one per lane (None in a lane without it), or None where it runs as Python, and
    why_python then.
    """

    by_each_muscle = True
    """Whether a point knows the contraction of every muscle, not just of the one it lies in."""

    def __init__(
        self,
        effect: ForceEffect | MaterialEffect,
        method: str,
        k: int,
        places: tuple[int, int],
        differences: Mapping[str, float],
        numbers: np.ndarray,
        reals: np.ndarray,
    ) -> None:
        self.effect, self.k, (self.points, self.per) = effect, k, places
        self.numbers, self.reals, self._method = numbers, reals, method
        steps = {name: step for name, step in differences.items() if name in effect.depends_on}
        self.moving = dict.fromkeys(steps, k)
        self._moved_once, self._moved_twice = Copies.one_sided(steps, k), Copies.central(steps, k)

    def _use(self, values: list[Any], muscles: int, recorded: Callable[[Any], Law]) -> None:
        """Take up lanes with these values (None without it): `own` ones of the effect, and its `surroundings`."""
        self.values, self._groups, self.why_python = values, grouped(values), ""
        self.answers = Answers(self, len(values), muscles)
        try:
            self.laws: list[Law | None] | None = alike(
                [None if one is None else recorded(one) for one in values]
            )
        except NotTraceableError as error:
            self.laws, self.why_python = None, str(error)

    def fixed(self, name: str, place: int) -> np.ndarray:
        """What does not move, [points, lanes]."""
        raise NotImplementedError

    def _rows(self, motion: Motion, mesh: Places, copies: Copies) -> Rows:
        """What moves, by name, in copies of the points, [copies, lanes, points, k]."""
        raise NotImplementedError

    def _state(
        self,
        rows: Rows,
        drive: DriveState,
        copies: int,
        lanes: np.ndarray,
        surroundings: Surroundings | None,
    ) -> Any:
        """The points in some lanes, one lane after the other and one copy after the other."""
        raise NotImplementedError

    def _respond(self, state: Any, values: SimpleNamespace) -> np.ndarray:
        return np.asarray(guarded(self.effect, self._method, state, values))

    def _answer(self, rows: Rows, drive: DriveState, copies: int, groups: Groups) -> np.ndarray:
        """The effect's answer in rows and for any groups of lanes with their values, [copies, lanes, points, k]."""

        def ask(lanes: np.ndarray, values: SimpleNamespace) -> np.ndarray | None:
            state = self._state(rows, drive, copies, lanes, values.surroundings)
            answer = self._respond(state, values.own)
            if len(lanes) == 1 or not state.looked:
                return answer
            self._groups = one_by_one(self._groups)
            return None

        return by_group(groups, (copies, len(self.values), self.points, self.k), ask)

    def fill(
        self, of: Any, motion: Motion, drive: DriveState, mesh: Places, rows: np.ndarray, exact: bool
    ) -> None:
        """Write the rows [rows, points, lanes] of a program, called as Python; central differences where exact, else
        one-sided ones, which find a step as well.
        """
        as_it_is = self._rows(motion, mesh, ALONE)
        if isinstance(of, tuple):
            rows[:] = self._change_with(of, as_it_is, drive)
            return
        copies = ALONE if of == "value" else self._moved_twice if exact else self._moved_once
        found = self._answer(self._rows(motion, mesh, copies), drive, len(copies), self._groups)
        alone = self._answer(as_it_is, drive, 1, self._groups) if copies is self._moved_twice else found
        rows[: self.k] = alone[0].transpose(2, 1, 0)
        if of == "response" and self.moving:
            slopes = np.zeros((len(self.moving), self.points, self.k, self.k, len(self.values)))
            for name, slope in zip(self.moving, slopes, strict=True):
                copies.add_derivative(name, found, np.ones(len(self.values)), slope)
            rows[self.k :] = slopes.transpose(0, 3, 2, 1, 4).reshape(rows[self.k :].shape)

    def _change_with(self, of: tuple[Any, Any], rows: Rows, drive: DriveState) -> np.ndarray:
        """Derivative by a parameter or by a muscle's contraction, [k, points, lanes]."""
        if of[0] == "contraction":
            own = np.arange(len(drive.contraction)) == of[1]
            step = _CONTRACTION_DIFFERENCE * (own if self.by_each_muscle else np.ones_like(own))[:, None]
            drives = [replace(drive, contraction=drive.contraction + sign * step) for sign in (1.0, -1.0)]
            more, less = (self._answer(rows, each, 1, self._groups) for each in drives)
            width: float | np.ndarray = 2 * _CONTRACTION_DIFFERENCE
        else:
            values, width = around(self.effect, of[0][1], self.values)
            more, less = (self._answer(rows, drive, 1, grouped(each)) for each in values)
        return (more - less)[0].transpose(2, 1, 0) / width


class Tapes:
    """Programs of bound laws.

    tables: what `tape_loops` takes: heads of all programs; inputs (source, component, register, second
    register of what is interpolated at sites, both components at once); what is uniform (0 a constant or 1 a signal,
    its row, register); operations; outputs (row, register, number, quantity that it is the derivative by or -1,
    component); numbers and reals; constants [n, lanes]; what is found; registers.
    """

    def __init__(self, wanted: Sequence[tuple[BoundLaw, Any]], lanes: int, muscles: int) -> None:
        """wanted: laws and what of them, see `Law.program`."""
        self._lane, self._muscles, self._wanted = lane_tuple(lanes), muscles, list(wanted)
        self._places: dict[int, tuple[int, int]] = {}
        self._fixed: dict[tuple[int, str, int], int] = {}
        self._heads: list[list[int]] = []
        self._inputs, self._uniform, self._outputs = [], [], []  # type: ignore[var-annotated]
        self._operations, self._numbers, self._reals = [], [], []  # type: ignore[var-annotated]
        self._constants: list[np.ndarray] = []
        self._counts = {"operations": 0, "numbers": 0, "reals": 0, "found": 0}
        registers = 1
        for law, of in wanted:
            registers = max(registers, self._append(law, of))

        def table(rows: Sequence[Sequence[int]], columns: int) -> np.ndarray:
            return np.array(rows, dtype=np.intp).reshape(-1, columns)

        none = np.zeros(0)
        self.tables = (
            table(self._heads, loops.HEAD),
            table(self._inputs, 4),
            table(self._uniform, 3),
            np.concatenate([np.zeros((0, 5), dtype=np.intp), *self._operations]),
            table(self._outputs, 5),
            np.concatenate([none, *self._numbers]).astype(np.intp),
            np.concatenate([none, *self._reals]),
            np.array(self._constants).reshape(-1, lanes),
            np.zeros(self._counts["found"]),
            np.zeros((registers, WIDTH)),
        )

    def _kept(self, kind: str, parts: list[np.ndarray], array: np.ndarray) -> int:
        """Where an array begins among others of its kind."""
        parts.append(array if kind == "operations" else array.ravel())
        self._counts[kind] += len(parts[-1])
        return self._counts[kind] - len(parts[-1])

    def _constant(self, value: np.ndarray | Sequence[float]) -> int:
        self._constants.append(np.broadcast_to(np.asarray(value, dtype=float), (len(self._lane),)))
        return len(self._constants) - 1

    def _append(self, law: BoundLaw, of: Any) -> int:
        """How many registers the program takes."""
        if id(law) not in self._places:
            numbers = self._kept("numbers", self._numbers, np.asarray(law.numbers))
            self._places[id(law)] = numbers, self._kept("reals", self._reals, law.reals)
        head = [0] * loops.HEAD
        head[loops.POINTS], head[loops.PER] = law.points, law.per
        head[loops.NUMBERS], head[loops.REALS] = self._places[id(law)]
        head[loops.INPUTS], head[loops.UNIFORM] = len(self._inputs), len(self._uniform)
        head[loops.OUTPUTS] = len(self._outputs)
        by = [(name, place) for name, count in law.moving.items() for place in range(count)]
        rows = law.k * (1 + len(by) if of == "response" else 1)
        head[loops.FOUND] = self._counts["found"]
        self._counts["found"] += rows * law.points * len(self._lane)
        if law.laws is None:
            head[loops.OPERATIONS_END] = -1
            outputs, registers = [(row, -1) for row in range(rows)], 0
        else:
            outputs, registers = self._write(law, of, head)
        for row, register in outputs:
            name, place = by[row // law.k - 1] if row >= law.k else (None, -1)
            self._outputs.append((row, register, row % law.k, _SOURCES.get(name, -1), place))
        head[loops.INPUTS_END], head[loops.UNIFORM_END] = len(self._inputs), len(self._uniform)
        head[loops.OUTPUTS_END] = len(self._outputs)
        self._heads.append(head)
        return registers

    def _write(self, law: BoundLaw, of: Any, head: list[int]) -> tuple[list[tuple[int, int]], int]:
        """Outputs of the programs of all lanes, which differ in constants only, and how many registers they take."""
        programs = [None if one is None else one.program(of) for one in law.laws]
        present = [program is not None for program in programs]
        first = present.index(True)
        program, values = programs[first], law.values[first].own
        head[loops.CONSTANTS] = self._constant(np.array(present, dtype=float))
        head[loops.BEFORE] = self._kept("operations", self._operations, program.before)
        head[loops.OPERATIONS] = self._kept("operations", self._operations, program.operations)
        head[loops.OPERATIONS_END] = self._counts["operations"]
        registers, unused = dict(program.inputs), program.registers
        for name, register in program.inputs:
            source, component = self._source(law, *name)
            if source <= loops.TANGENT_RATE:
                pair = [registers.get((name[0], place), unused) for place in range(2)]
                if component == 0 or pair[0] == unused:
                    self._inputs.append((source, 0, *pair))
            else:
                self._inputs.append((source, component, register, unused))
        for n, (name, register) in enumerate(program.uniform):
            if isinstance(name[0], str):
                signal = {"contraction": 1, "voltage": 1 + self._muscles, "time": 1 + 2 * self._muscles}
                self._uniform.append((1, signal[name[0]] + name[1], register))
                continue
            if name[0] is None:
                each = [(one or program).uniform[n][0][1] for one in programs]
            else:
                own = [values if one is None else one.own for one in law.values]
                parameter = next(p for p in law.effect.parameters if p.name == name[0][1])
                each = [getattr(p, parameter.name) for p in own]
                if name == of:
                    # beside the end of its range, where what holds a root or an absolute value has a kink
                    each = [0.5 * sum(parameter.around(value)[:2]) for value in each]
            self._uniform.append((0, self._constant(each), register))
        return program.outputs, program.registers + 1

    def _source(self, law: BoundLaw, name: str, place: int) -> tuple[int, int]:
        if name in _SOURCES:
            return _SOURCES[name], place
        if name in ("contraction", "voltage"):
            return loops.OF_MUSCLE, self._muscles * (name == "voltage")
        key = id(law), name, place
        if key not in self._fixed:
            fixed = np.ascontiguousarray(law.fixed(name, place), dtype=float)
            self._fixed[key] = self._kept("reals", self._reals, fixed)
        return loops.FIXED, self._fixed[key]

    def rows(self, program: int) -> np.ndarray:
        """What a program found, [rows, points, lanes]."""
        (law, of), head = self._wanted[program], self.tables[0][program]
        rows = law.k * (1 + sum(law.moving.values()) if of == "response" else 1)
        shape = rows, law.points, len(self._lane)
        return self.tables[8][head[loops.FOUND] :][: int(np.prod(shape))].reshape(shape)

    def evaluate(self, program: int, motion: Motion, drive: DriveState, mesh: Places) -> np.ndarray:
        """Do a program; its rows [rows, points, lanes], which the next evaluation overwrites."""
        if not self.fill(program, motion, drive, mesh):
            loops.evaluate(self.tables, program, motion.fields, mesh, drive.signals, self._lane)
        return self.rows(program)

    def fill(self, program: int, motion: Motion, drive: DriveState, mesh: Places, exact: bool = True) -> bool:
        """Do a program if its law runs as Python, and whether it does.

        exact: whether it is differentiated as exactly as differences can.
        """
        law, of = self._wanted[program]
        if law.laws is None:
            law.fill(of, motion, drive, mesh, self.rows(program), exact)
        return law.laws is None


class Answers:
    """The programs of one law, each made when it is first asked for."""

    def __init__(self, law: BoundLaw, lanes: int, muscles: int) -> None:
        self._law, self._lanes, self._muscles = law, lanes, muscles
        self._tapes: dict[Any, Tapes] = {}

    def __call__(self, of: Any, motion: Motion, drive: DriveState, mesh: Places) -> np.ndarray:
        """Rows [rows, points, lanes] of one of them, see `Law.program`."""
        if of not in self._tapes:
            self._tapes[of] = Tapes([(self._law, of)], self._lanes, self._muscles)
        return self._tapes[of].evaluate(0, motion, drive, mesh).copy()
