"""One time step of the bodies in all lanes, and of the derivatives of their states by parameters."""

from dataclasses import dataclass, replace

import numpy as np

from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.banded import BandFactors, BandMatrix
from hasel_sim.mechanics.compiled import combine, corrected
from hasel_sim.mechanics.generalised_alpha import StepCoefficients
from hasel_sim.mechanics.motion import DriveState, Memory, Motion
from hasel_sim.mechanics.newton import Newton
from hasel_sim.mechanics.residual_slopes import ResidualSlope, SolidSlope
from hasel_sim.mechanics.simd import lane_tuple
from hasel_sim.mechanics.state import State, StateSlopes
from hasel_sim.mechanics.system import Linearisation, System

_MOST_ITERATIONS, _MOST_KEPT = 15, 5
_SLOW = 0.1
"""Corrections that shrink by less than this want a matrix of their own."""
_MOST_HALVINGS = 8
"""A step that cannot be followed is halved up to this often: to 1/256 of its length."""


def _combined(
    state: State, new: np.ndarray, weights: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    x, v, a = np.empty_like(new), np.empty_like(new), np.empty_like(new)
    lane = lane_tuple(new.shape[-1])
    combine(state.position, state.velocity, state.acceleration, new, weights, x, v, a, lane)
    return x, v, a


def balance_motion(state: State, c: StepCoefficients, acceleration: np.ndarray) -> Motion:
    """Motion at the instant of balance for an end-of-step acceleration."""
    return Motion(*_combined(state, acceleration, c.to_balance))


@dataclass(frozen=True)
class Part:
    """A step, or a part of one that had to be divided: the states around it, the motion and the drive in between."""

    before: State
    after: State
    motion: Motion
    drive: DriveState
    coefficients: StepCoefficients


class Stepper:
    """Advances a `System` by generalised-alpha steps; one factorisation a step is enough but for violent motion.

    No lane depends on another: each takes the steps, and ends with the numbers, that it would alone.
    tolerance: largest error of a nodal position [m] left by Newton's method. A correction made with a fresh matrix
    leaves about its square over the length of an element.
    """

    def __init__(self, system: System, tolerance: float) -> None:
        self.system, self.tolerance = system, tolerance
        self._matrix: BandMatrix | None = None
        self.newton = Newton(system)
        corners = system.nodes[system.mesh.elements]
        self._length = float(np.ptp(corners, axis=1).max(axis=1).min())
        self._jerk: np.ndarray | None = None
        self._stress: np.ndarray | None = None
        self.iterations = self.factorisations = 0

    def of_lane(self, lane: int, system: System) -> "Stepper":
        """A stepper of one lane's own system that goes on where this one is."""
        out = Stepper(system, self.tolerance)
        if self._stress is not None:
            out._jerk, out._stress = self._jerk[..., [lane]], self._stress[..., [lane]]
        return out

    def put_lane(self, lane: int, other: "Stepper") -> None:
        """Go on in a lane where another stepper is that made its step."""
        if self._stress is not None:
            self._jerk[..., lane], self._stress[..., lane] = other._jerk[..., 0], other._stress[..., 0]

    def memory(self, state: State, at: float | np.ndarray) -> Memory:
        """What the branches carry from a step's start to `at` [s] into it."""
        branches = self.system.solid.branches
        return Memory() if len(branches) == 0 else Memory(branches.history(state.branch, state.green, at), at)

    def factorise(self, line: Linearisation, c: StepCoefficients) -> BandFactors:
        """Factors of the derivative of the residual by the end-of-step acceleration."""
        self._matrix = line.matrix(c.position, c.velocity, c.acceleration, self._matrix)
        self.factorisations += 1
        return self._matrix.factorise()

    def follow(
        self, state: State, drive: DriveState, c: StepCoefficients, halvings: int = _MOST_HALVINGS
    ) -> list[Part]:
        """Make a step of a single lane, in as few parts as it can be followed in; the contraction holds throughout.

        Raises SimulationError where even the smallest part fails.
        """
        part, found = self.step(state, drive, c, np.ones(1, dtype=bool))
        if found.all():
            return [part]
        if halvings == 0:
            raise SimulationError(
                f"the motion could not be followed beyond t = {drive.time[0]:.4f} s, not even with steps divided by "
                f"{2**_MOST_HALVINGS}; expected parameters at which the body stays whole: move extreme values back "
                "into their plausible range or raise numerics.steps_per_second"
            )
        half, start = c.halved(), drive.time - c.at
        first = self.follow(state, replace(drive, time=start + half.at), half, halvings - 1)
        later = replace(drive, time=start + half.step + half.at)
        return first + self.follow(first[-1].after, later, half, halvings - 1)

    def step(
        self, state: State, drive: DriveState, c: StepCoefficients, wanted: np.ndarray
    ) -> tuple[Part, np.ndarray]:
        """Make a step in the lanes wanted [lanes]; those in which it was found come back, the others stay."""
        memory = self.memory(state, c.at)
        acceleration, found = state.acceleration, np.zeros_like(wanted)
        self.newton.begin(state, drive, c, memory)
        near = acceleration if self._jerk is None else acceleration + c.step * self._jerk
        for guess, keep in ((near, True), (near, False), (state.acceleration, False)):
            tried, arrived = self._balance(c, guess, wanted & ~found, keep)
            acceleration = tried if arrived.all() else np.where(arrived, tried, acceleration)
            found |= arrived
            if found[wanted].all():
                break
        motion = balance_motion(state, c, acceleration)
        after = self._end(state, c, acceleration)
        self.newton.evaluate(acceleration)
        stress, jerk = self.newton.second_piola(), (acceleration - state.acceleration) / c.step
        if not found.all():
            after.put(~found, state, ~found)
            if self._stress is not None:
                stress[..., ~found], jerk[..., ~found] = self._stress[..., ~found], self._jerk[..., ~found]
        if found.any():
            self._stress, self._jerk = stress, jerk
        return Part(state, after, motion, drive, c), found

    def _balance(
        self, c: StepCoefficients, guess: np.ndarray, wanted: np.ndarray, keep: bool
    ) -> tuple[np.ndarray, np.ndarray]:
        """The end-of-step acceleration by Newton's method from a guess, and the lanes in which it converged.

        keep: with the first matrix throughout, and no lane that this does not bring close fast.
        """
        acceleration, arrived, last = guess, np.zeros_like(wanted), self._length
        for iteration in range(_MOST_KEPT if keep else _MOST_ITERATIONS):
            motion = self.newton.evaluate(acceleration)
            fresh = iteration == 0 or not keep
            try:
                correction, singular = self.newton.correction(
                    motion, fresh, self._stress if iteration == 0 else None
                )
            except SimulationError:  # a guess that turns elements inside out says nothing of the next guess
                break
            self.factorisations += fresh
            new, size = np.empty_like(correction), np.empty(len(wanted))
            corrected(acceleration, correction, wanted & ~singular, new, size)
            size *= c.end_position
            going_on = wanted & np.isfinite(size) & ~singular
            if iteration:
                going_on &= size <= (_SLOW if keep else 1.0) * last
            if (going_on != wanted).any():
                new = np.where(going_on, new, acceleration)
            acceleration, wanted = new, going_on
            fresh_enough = fresh & (size**2 < self.tolerance * self._length)
            here = wanted & ((size < self.tolerance) | fresh_enough)
            arrived, wanted, last = arrived | here, wanted & ~here, size
            self.iterations += 1
            if not wanted.any():
                break
        return acceleration, arrived

    def _end(self, state: State, c: StepCoefficients, acceleration: np.ndarray) -> State:
        after = State(*_combined(state, acceleration, c.to_end))
        solid = self.system.solid
        if len(solid.branches):
            after.green = solid.green_stress(solid.gradient(after.position))
            after.branch = solid.branches.advance(state.branch, state.green, after.green, c.step)
        return after

    def step_slopes(
        self,
        part: Part,
        slopes: StateSlopes,
        parameters: list[ResidualSlope],
        contraction_slopes: np.ndarray,
    ) -> StateSlopes:
        """Derivatives of the state after a part, exact to the tolerance of the step: one factorisation serves all.

        slopes: derivatives of the state before; contraction_slopes: of the contraction, [columns, muscles, lanes].
        """
        state, motion, drive, c = part.before, part.motion, part.drive, part.coefficients
        line = self.system.linearise(motion, drive, self.memory(state, c.at))
        shift = slopes.position + c.position_v * slopes.velocity + c.position_a * slopes.acceleration
        rate = slopes.velocity + c.velocity_a * slopes.acceleration
        stress = None if slopes.branch is None else self._history_stress(line, slopes, c.at)
        # K shift is the matrix times shift / c.position, less what that brings of damping and inertia
        instead = shift / c.position
        inertia = c.acceleration_a * slopes.acceleration - c.acceleration * instead
        right = line.along(None, rate - c.velocity * instead, inertia, stress)
        if contraction_slopes.any():
            right += np.einsum("cml,mndl->cndl", contraction_slopes, line.by_contraction(drive))
        for column, parameter in enumerate(parameters):
            parameter.add(motion, drive, line, state, c.at, right[column])
        self.system.held_to_zero(right)
        acceleration = -instead - self.factorise(line, c).solve(right)
        out = StateSlopes(
            slopes.position
            + c.step * slopes.velocity
            + c.end_position_a * slopes.acceleration
            + c.end_position * acceleration,
            slopes.velocity + c.end_velocity_a * slopes.acceleration + c.end_velocity * acceleration,
            acceleration,
        )
        if slopes.branch is not None:
            self._advance_branch_slopes(state, part.after, c, slopes, parameters, out)
        return out

    def _history_stress(self, line: Linearisation, slopes: StateSlopes, at: float | np.ndarray) -> np.ndarray:
        left, gain = self.system.solid.branches.factors(at)
        S = np.einsum("bl,cbegsl->cegsl", left, slopes.branch) - gain.sum(axis=0) * slopes.green
        xx, yy, xy = np.moveaxis(S, -2, 0)
        a, b, c, d = np.moveaxis(line.F, -2, 0)
        return np.stack([a * xx + b * xy, a * xy + b * yy, c * xx + d * xy, c * xy + d * yy], axis=-2)

    def _advance_branch_slopes(self, state, after, c, slopes, parameters, out: StateSlopes) -> None:
        solid = self.system.solid
        out.green = np.empty_like(slopes.green)
        F = solid.gradient(after.position)
        for column in range(len(parameters)):
            out.green[column] = solid.green_stress_along(F, solid.gradient(out.position[column]))
        left, gain = (factor[:, None, None, None] for factor in solid.branches.factors(c.step))
        out.branch = left * slopes.branch + gain * (out.green - slopes.green)[:, None]
        for column, parameter in enumerate(parameters):
            if isinstance(parameter, SolidSlope):
                self._add_branch_parameter(parameter, state, after, c.step, out, column)

    def _add_branch_parameter(
        self, parameter: SolidSlope, state, after, step, out: StateSlopes, column: int
    ) -> None:
        for solid, sign in parameter.solids:
            green = solid.green_stress(solid.gradient(after.position))
            out.green[column] += sign / parameter.width * green
            advanced = solid.branches.advance(state.branch, state.green, green, step)
            out.branch[column] += sign / parameter.width * advanced
