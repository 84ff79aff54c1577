# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Bodies that step together, the calls of effects between compiled steps, and a single body with divided steps."""

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from operator import is_not

import numpy as np

from hasel_sim.dynamics.generalised_alpha import SolvedStep, StepCoefficients, balance_motion
from hasel_sim.dynamics.parameter_columns import ResidualSlope
from hasel_sim.dynamics.step_derivatives import StepSlopes
from hasel_sim.dynamics.system import LawTable, System
from hasel_sim.dynamics.time_loop import (
    BALANCE,
    COMMIT,
    DIFFERENTIATE,
    MOST_ITERATIONS,
    MOST_WITH_ONE_MATRIX,
    PREDICT,
    integrate,
)
from hasel_sim.errors import SimulationError
from hasel_sim.laws.python_calls import say_once
from hasel_sim.mechanics.state import DriveState, NodeTrajectories, State, StateSlopes
from hasel_sim.simd import lane_tuple

_MOST_HALVINGS = 8
"""A step that cannot be followed is halved up to this often: to 1/256 of its length."""
_NO_MARKERS = np.zeros((0, 8), dtype=np.intp)
Derivatives = tuple[StateSlopes, np.ndarray]
"""Of a state by parameters, and of the contraction [columns, muscles]."""


class Integrator:
    """Steps a `System`; each lane takes the steps, and ends with the numbers, that it would alone.

    tolerance: largest error of a nodal position [m] left by Newton's method. A correction made with a fresh matrix
    leaves about its square over the length of an element.
    """

    def __init__(self, system: System, tolerance: float, parameters: Sequence[ResidualSlope] = ()) -> None:
        """parameters: those by which the motion is differentiated along the way."""
        self.system, self.tolerance, lanes = system, tolerance, system.lanes
        nodal, points = (*system.nodes.shape, lanes), system.solid.areas.shape
        self._lane = lane_tuple(lanes)
        length = float(np.ptp(system.nodes[system.mesh.elements], axis=1).max(axis=1).min())
        self._limits = tolerance, tolerance * length
        matrix = system.band_matrix()
        self._body, self._matrix, self._laws = system.for_loops, matrix.for_loops, LawTable(system)
        self._slopes = StepSlopes(system, parameters, self._laws.by_rate, matrix.padding)
        self._guess, self._history = np.empty(nodal), np.zeros((*points, 3, lanes))
        self._room = (
            *(np.empty(nodal) for _ in range(3)),
            np.zeros((nodal[0] + matrix.padding, 2, lanes)),
            *(np.empty((*points, n, lanes)) for n in (3, 4, 3)),
        )
        self._wanted, self.arrived, self._due = (np.zeros(lanes, dtype=bool) for _ in range(3))
        self.coefficients: Sequence[StepCoefficients] = ()
        self._seconds = [0.0, 0.0]
        self._progress = self._wanted, self.arrived, self._due, np.zeros(lanes)

    def begin(self, state: State, stress: np.ndarray, jerk: np.ndarray) -> None:
        """Take up bodies in a state, which is moved in place from now on.

        stress: second Piola stress [Pa] at the last balance [elements, points, 3, lanes]; jerk: rate of the
        acceleration [m/s^3].
        """
        self.state, self.stress, self.jerk = state, stress, jerk

    def plan(
        self,
        drives: DriveState,
        kinds: np.ndarray,
        coefficients: Sequence[StepCoefficients],
        ends: np.ndarray,
        kept: NodeTrajectories,
        slopes: StateSlopes,
        by_contraction: np.ndarray,
    ) -> None:
        """What to do from here.

        drives: at the balance of every step; kinds: of every step [steps], numbers among the coefficients; ends: how
        many steps each lane makes [lanes]; slopes: derivatives of the state by the parameters, which are moved in place
        from now on; by_contraction: those of the contraction [steps, columns, muscles, lanes].
        """
        self.drives, self.ends = drives, ends
        self._trajectories, self._kinds = (kept.nodes, kept.local, kept.shapes, kept.slopes), kinds
        if len(coefficients) != len(self.coefficients) or any(map(is_not, coefficients, self.coefficients)):
            self.coefficients = coefficients
            self._tabulate()
        solid, branches = self.system.solid, (self.state.branch, self.state.green)
        none = np.zeros((0, 1, 1, 3, self.system.lanes)), np.zeros((1, 1, 3, self.system.lanes))
        stresses = branches if len(solid.branches) else none
        self._memory = *stresses, *self._factors, (solid.shear, solid.linear_lame)
        self._plan = kinds, self._scheme, self._tables, drives.signals, ends
        self._derivatives = self._slopes.plan(slopes, by_contraction, coefficients)

    def _tabulate(self) -> None:
        """What depends on the kind of a step."""
        each, solid, lanes = self.coefficients, self.system.solid, self.system.lanes

        def table(of_one: Callable[[StepCoefficients], np.ndarray]) -> np.ndarray:
            return np.stack([np.broadcast_to(of_one(c), (*np.shape(of_one(c))[:-1], lanes)) for c in each])

        self._scheme = (
            table(lambda c: c.to_balance),
            table(lambda c: c.matrix_weights),
            table(lambda c: c.to_end),
            table(lambda c: np.atleast_1d(c.end_position)),
            table(lambda c: np.atleast_1d(c.step)),
        )
        self._factors: tuple[np.ndarray, ...]
        if len(solid.branches) == 0:
            self._factors, self._tables = (np.zeros((1, 0, lanes)),) * 4, solid.table(0.0)[None]
            return
        factors = [solid.branches.factors(c.at) + solid.branches.factors(c.step) for c in each]
        self._factors = tuple(np.stack(f) for f in zip(*factors, strict=True))
        self._tables = np.stack([solid.table(c.at) for c in each])

    def advance(self, first: int, last: int) -> int:
        """Make steps from the first until before the last, or to one that fails in a lane: this step comes back.

        `arrived` tells which lanes made it; where the nodes are after it is kept all the same.
        """
        step = self.advance_with_one_matrix(first, last)
        while step < last and self.try_again(step):
            step += 1
            if step < last:
                step = self.advance_with_one_matrix(step, last)
        return step

    def advance_with_one_matrix(self, first: int, last: int) -> int:
        """The same, with a single matrix for every step."""
        if not self._laws.as_python:
            return self._integrate(PREDICT | BALANCE | DIFFERENTIATE | COMMIT, (first, last))
        for step in range(first, last):
            self._integrate(PREDICT, (step, step + 1))
            self._balance(step, one_matrix=True)
            if self._end(step) == step:
                return step
        return last

    def try_again(self, step: int) -> bool:
        """Make a step where it failed, with a matrix for every correction; whether all lanes have made it now.

        It starts from the extrapolated acceleration, then from the last, then from none: after a step that was much
        shorter neither of the first two says anything.
        """
        made = self.arrived.copy()
        for start in (None, self.state.acceleration, 0.0):
            self._integrate(PREDICT, (step, step + 1))
            if start is not None:
                self._guess[:] = start
            self._wanted &= ~made
            self._balance(step, one_matrix=False)
            self._end(step)
            made |= self.arrived
            self.arrived[:] = made
            if made[step < self.ends].all():
                return True
        return False

    def _integrate(self, parts: int, steps: tuple[int, int], how: tuple[int, int, bool] | None = None) -> int:
        return integrate(
            parts,
            steps,
            (self._limits, (*(how or (0, MOST_WITH_ONE_MATRIX + 1, False)), len(self._slopes) > 0)),
            (self.state.position, self.state.velocity, self.state.acceleration, self.jerk),
            self._plan,
            self._body,
            self._matrix,
            (self._laws.terms, self._laws.tapes.tables, self._laws.programs),
            self._memory,
            self._derivatives,
            self._history,
            self.stress,
            self._guess,
            self._room,
            self._trajectories,
            self._progress,
            self._lane,
        )

    def _end(self, step: int) -> int:
        """Differentiate a step that was found, and go to its end; see `integrate`."""
        if len(self._slopes) and self._laws.as_python and self.arrived.any():
            drive = self.drives.at(step)
            acceleration = np.where(self.arrived, self._guess, self.state.acceleration)
            motion = balance_motion(self.state, acceleration, self._scheme[0][self._kinds[step]])
            self._laws.call(motion, drive, with_slopes=True, exact=True)
            self._slopes.columns.call(motion, drive)
        return self._integrate(DIFFERENTIATE | COMMIT, (step, step + 1))

    def _balance(self, step: int, one_matrix: bool) -> None:
        """Find the acceleration at the end of a step; effects that run as Python are called before every correction."""
        most = MOST_WITH_ONE_MATRIX if one_matrix else MOST_ITERATIONS
        if not self._laws.as_python:
            self._integrate(BALANCE, (step, step + 1), (0, most + 1, not one_matrix))
            return
        kind, drive = self._kinds[step], self.drives.at(step)
        start = time.process_time()
        for iteration in range(most + 1):
            more = bool((self._wanted & ~self.arrived).any())
            if not more and (len(self._slopes) or not self._due.any()):
                break
            fresh = more and (iteration == 0 or not one_matrix)
            motion = balance_motion(self.state, self._guess, self._scheme[0][kind])
            before = time.process_time()
            self._laws.call(motion, drive, with_slopes=fresh)
            self._seconds[0] += time.process_time() - before
            self._integrate(BALANCE, (step, step + 1), (iteration, iteration + 1, not one_matrix))
        self._seconds[1] += time.process_time() - start

    def say_what_runs_as_python(self) -> None:
        """One line for every effect that does, the first time, with how many times as long the steps take by all."""
        called, all_in_all = self._seconds
        if all_in_all > called:
            say_once(self._laws.python_laws(), all_in_all / (all_in_all - called))


class Stepper:
    """Advances a `System` of one lane by generalised-alpha steps.

    tolerance: see `Integrator`; parameters: those by which the motion is differentiated.
    """

    def __init__(self, system: System, tolerance: float, parameters: Sequence[ResidualSlope] = ()) -> None:
        self.system, self.tolerance, self.parameters = system, tolerance, parameters
        self.integrator: Integrator | None = None
        self.jerk: np.ndarray | None = None
        self.stress: np.ndarray | None = None

    def start(self, state: State, drive: DriveState) -> None:
        """Set off from a first state, with the drive it is in equilibrium with."""
        stress = self.system.second_piola(state.motion, drive, self.system.memory(state))
        self.begin(np.zeros_like(state.position), stress)

    def begin(self, jerk: np.ndarray, stress: np.ndarray) -> None:
        """Go on after a step with this rate of the acceleration [m/s^3] and this second Piola stress [Pa]."""
        self.jerk, self.stress = jerk, stress

    def follow(
        self,
        state: State,
        drive: DriveState,
        c: StepCoefficients,
        derivatives: Derivatives | None = None,
        halvings: int = _MOST_HALVINGS,
    ) -> list[SolvedStep]:
        """Make a step of a single lane, in as few parts as it can be followed in; the contraction holds throughout.

        derivatives: of the state by the parameters, brought to the step's end in place, and of the contraction
        [columns, muscles]. Raises SimulationError where even the smallest part fails.
        """
        whole = self.step(state, drive, c, derivatives)
        if whole is not None:
            return [whole]
        if halvings == 0:
            raise SimulationError(
                f"the motion could not be followed beyond t = {drive.time[0]:.4f} s, not even with steps divided by "
                f"{2**_MOST_HALVINGS}; expected parameters at which the body stays whole: move extreme values back "
                "into their plausible range or raise numerics.steps_per_second"
            )
        half, start = c.halved(), drive.time - c.at
        first = self.follow(state, replace(drive, time=start + half.at), half, derivatives, halvings - 1)
        later = replace(drive, time=start + half.step + half.at)
        return first + self.follow(first[-1].after, later, half, derivatives, halvings - 1)

    def step(
        self, state: State, drive: DriveState, c: StepCoefficients, derivatives: Derivatives | None = None
    ) -> SolvedStep | None:
        """Make a step of a single lane; None where it is not found."""
        if self.integrator is None:
            self.integrator = Integrator(self.system, self.tolerance, self.parameters)
        if self.jerk is None or self.stress is None:
            self.start(state, drive)
        integrator, after, one = self.integrator, state.copy(), np.ones(1, dtype=int)
        drives = DriveState(drive.voltage[None], drive.contraction[None], drive.time[None])
        none = np.zeros((0, *state.position.shape))
        no_derivatives = StateSlopes(none, none, none), np.zeros((0, self.system.muscles))
        slopes, by_contraction = derivatives or no_derivatives
        integrator.begin(after, self.stress, self.jerk)
        kept = NodeTrajectories.of(_NO_MARKERS, 2, state, len(self.parameters), False)
        integrator.plan(drives, 0 * one, [c], one, kept, slopes, by_contraction[None, ..., None])
        found = integrator.advance(0, 1) == 1
        return SolvedStep.between(state, after, drive, c) if found else None
