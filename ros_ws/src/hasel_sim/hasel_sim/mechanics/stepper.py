"""One time step of the body, and of the derivatives of its state by parameters."""

from dataclasses import dataclass, replace

import numpy as np

from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.banded import BandFactors, BandMatrix
from hasel_sim.mechanics.branches import green_stress_direction
from hasel_sim.mechanics.generalised_alpha import StepCoefficients
from hasel_sim.mechanics.motion import DriveState, Memory, Motion
from hasel_sim.mechanics.residual_slopes import ResidualSlope, SolidSlope
from hasel_sim.mechanics.state import State, StateSlopes
from hasel_sim.mechanics.system import Linearisation, System

_MOST_ITERATIONS = 25
_MOST_HALVINGS = 8
"""A step that cannot be followed is halved up to this often: to 1/256 of its length."""
_SLOW = 0.1
"""A correction shrinking by less than this makes a kept factorisation not worth keeping."""


def balance_motion(state: State, c: StepCoefficients, acceleration: np.ndarray) -> Motion:
    """Motion at the instant of balance for an end-of-step acceleration."""
    return Motion(
        state.position
        + c.position_v * state.velocity
        + c.position_a * state.acceleration
        + c.position * acceleration,
        state.velocity + c.velocity_a * state.acceleration + c.velocity * acceleration,
        c.acceleration_a * state.acceleration + c.acceleration * acceleration,
    )


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

    tolerance: largest error of a nodal position [m] left by Newton's method. A correction made with a fresh matrix
    leaves about its square over the length of an element.
    """

    def __init__(self, system: System, tolerance: float) -> None:
        self.system, self.tolerance = system, tolerance
        self._matrix: BandMatrix | None = None
        self._factors: BandFactors | None = None
        corners = system.nodes[system.mesh.elements]
        self._length = float(np.ptp(corners, axis=1).max(axis=1).min())
        self._jerk: np.ndarray | None = None
        self._stress: np.ndarray | None = None
        self.iterations = self.factorisations = 0

    def memory(self, state: State, at: float) -> Memory:
        """What the branches carry from a step's start to `at` [s] into it."""
        branches = self.system.solid.branches
        return Memory() if len(branches) == 0 else Memory(branches.history(state.branch, state.green, at), at)

    def factorise(self, line: Linearisation, c: StepCoefficients) -> BandFactors:
        """Factors of the derivative of the residual by the end-of-step acceleration."""
        self._matrix = line.matrix(c.position, c.velocity, c.acceleration, self._matrix)
        self._factors = self._matrix.factorise()
        self.factorisations += 1
        return self._factors

    def follow(
        self, state: State, drive: DriveState, c: StepCoefficients, halvings: int = _MOST_HALVINGS
    ) -> list[Part]:
        """Make a step, in as few parts as it can be followed in; the drive's contraction holds throughout.

        Raises SimulationError where even the smallest part fails.
        """
        try:
            after, motion = self.step(state, drive, c)
        except SimulationError:
            if halvings == 0:
                raise
            half, start = c.halved(), drive.time - c.at
            first = self.follow(state, replace(drive, time=start + half.at), half, halvings - 1)
            later = replace(drive, time=start + half.step + half.at)
            return first + self.follow(first[-1].after, later, half, halvings - 1)
        return [Part(state, after, motion, drive, c)]

    def step(self, state: State, drive: DriveState, c: StepCoefficients) -> tuple[State, Motion]:
        """The state after a step and the motion at which forces balance. Raises SimulationError when Newton fails."""
        memory = self.memory(state, c.at)
        kept = state.acceleration
        guesses = [kept] if self._jerk is None else [kept + c.step * self._jerk, kept]
        for guess in guesses:
            acceleration = self._balance(state, drive, c, memory, guess)
            if acceleration is not None:
                break
        else:
            self._fail(drive)
        self._jerk = (acceleration - state.acceleration) / c.step
        motion = balance_motion(state, c, acceleration)
        self._stress = self.system.second_piola(motion, drive, memory)
        return self._end(state, c, acceleration), motion

    def _balance(
        self, state: State, drive: DriveState, c: StepCoefficients, memory: Memory, guess: np.ndarray
    ) -> np.ndarray | None:
        """The end-of-step acceleration by Newton's method from a guess; None where it does not converge."""
        acceleration = guess.copy()
        stale, last = True, np.inf
        for iteration in range(_MOST_ITERATIONS):
            motion = balance_motion(state, c, acceleration)
            fresh = stale
            if stale:
                line = self.system.linearise(motion, drive, memory)
                if iteration == 0 and self._stress is not None:
                    line.with_initial_stress(self.system.second_piola(motion, drive, memory), self._stress)
                try:
                    self.factorise(line, c)
                except (
                    SimulationError
                ):  # a guess that turns an element inside out says nothing of the next guess
                    return None
            correction = self._factors.solve(self.system.residual(motion, drive, memory)[None])[0]
            acceleration -= correction
            size = c.end_position * float(np.abs(correction).max())
            self.iterations += 1
            if size < self.tolerance or (fresh and size**2 < self.tolerance * self._length):
                return acceleration
            if not np.isfinite(size) or (iteration and size > 1e3 * last):
                return None
            stale = size > _SLOW * last
            last = size
        return None

    def _fail(self, drive: DriveState) -> None:
        raise SimulationError(
            f"the motion could not be followed beyond t = {drive.time:.4f} s, not even with steps divided by "
            f"{2**_MOST_HALVINGS}; expected parameters at which the body stays whole: move extreme values back into "
            "their plausible range or raise numerics.steps_per_second"
        )

    def _end(self, state: State, c: StepCoefficients, acceleration: np.ndarray) -> State:
        after = State(
            state.position
            + c.step * state.velocity
            + c.end_position_a * state.acceleration
            + c.end_position * acceleration,
            state.velocity + c.end_velocity_a * state.acceleration + c.end_velocity * acceleration,
            acceleration,
        )
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

        slopes: derivatives of the state before; contraction_slopes: of the contraction, [columns, muscles].
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
        right += np.tensordot(contraction_slopes, line.by_contraction(drive), 1)
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

    def _history_stress(self, line: Linearisation, slopes: StateSlopes, at: float) -> np.ndarray:
        left, gain = self.system.solid.branches.factors(at)
        S = np.einsum("b,cbegs->cegs", left, slopes.branch) - gain.sum() * slopes.green
        F = line.F
        xx, yy, xy = S[..., 0], S[..., 1], S[..., 2]
        a, b, c, d = F[..., 0], F[..., 1], F[..., 2], F[..., 3]
        return np.stack([a * xx + b * xy, a * xy + b * yy, c * xx + d * xy, c * xy + d * yy], axis=-1)

    def _advance_branch_slopes(self, state, after, c, slopes, parameters, out: StateSlopes) -> None:
        solid = self.system.solid
        out.green = np.empty_like(slopes.green)
        F = solid.gradient(after.position)
        for column in range(len(parameters)):
            green_stress_direction(
                F, solid.gradient(out.position[column]), solid.shear, solid.linear_lame, out.green[column]
            )
        left, gain = solid.branches.factors(c.step)
        change = out.green - slopes.green
        out.branch = (
            np.einsum("b,cbegs->cbegs", left, slopes.branch) + gain[:, None, None, None] * change[:, None]
        )
        for column, parameter in enumerate(parameters):
            if isinstance(parameter, SolidSlope):
                self._add_branch_parameter(parameter, state, after, c.step, out, column)

    def _add_branch_parameter(
        self, parameter: SolidSlope, state, after, step, out: StateSlopes, column: int
    ) -> None:
        for solid, sign in ((parameter.more, 1.0), (parameter.less, -1.0)):
            green = solid.green_stress(solid.gradient(after.position))
            out.green[column] += sign / parameter.width * green
            advanced = solid.branches.advance(state.branch, state.green, green, step)
            out.branch[column] += sign / parameter.width * advanced
