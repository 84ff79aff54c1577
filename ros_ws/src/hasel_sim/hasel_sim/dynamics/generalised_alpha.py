# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The generalised-alpha method, second order with chosen damping of what the step cannot resolve.

Forces and inertia are balanced once per step at interpolated positions, velocities and accelerations ("generalised
mid-point"); rho = 1 is the implicit mid-point rule, which keeps momentum and angular momentum.
J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np

from hasel_sim.mechanics.state import DriveState, Motion, State, combine
from hasel_sim.simd import lane_tuple


@dataclass(frozen=True)
class StepCoefficients:
    """What one step of length `step` [s] does with the end-of-step acceleration a1.

    x = x0 + position_gain_v v0 + position_gain_a a0 + position_gain a1 where forces are balanced, and likewise for the
    velocity and the acceleration; the `end_` values lead to the end of the step.
    """

    step: float
    at: float
    position_v: float
    position_a: float
    position: float
    velocity_a: float
    velocity: float
    acceleration_a: float
    acceleration: float
    end_position_a: float
    end_position: float
    end_velocity_a: float
    end_velocity: float

    @cached_property
    def to_balance(self) -> np.ndarray:
        """Weights for `state.combine` that lead to where forces are balanced, [8, lanes]."""
        position = self.position_v, self.position_a, self.position
        return _weights(*position, self.velocity_a, self.velocity, self.acceleration_a, self.acceleration)

    @cached_property
    def matrix_weights(self) -> np.ndarray:
        """Weights of stiffness, damping and mass in the matrix of a step, [3, lanes]."""
        return _weights(self.position, self.velocity, self.acceleration)[:3].copy()

    @cached_property
    def to_end(self) -> np.ndarray:
        """Weights for `state.combine` that lead to the end of the step, [8, lanes]."""
        position = self.step, self.end_position_a, self.end_position
        return _weights(*position, self.end_velocity_a, self.end_velocity, 0.0, 1.0)

    @staticmethod
    def beside(each: Sequence["StepCoefficients"]) -> "StepCoefficients":
        """Those of several lanes, whose steps may differ in length: every coefficient an array [lanes]."""
        names = (field.name for field in fields(StepCoefficients))
        return StepCoefficients(**{name: np.array([getattr(c, name) for c in each]) for name in names})  # type: ignore[arg-type]

    def halved(self) -> "StepCoefficients":
        """Those of a step of half the length."""
        half = {name: 0.5 * getattr(self, name) for name in _LIKE_THE_STEP}
        return replace(self, **half, **{name: 0.25 * getattr(self, name) for name in _LIKE_ITS_SQUARE})


def _weights(*each: float | np.ndarray) -> np.ndarray:
    return np.array(np.broadcast_arrays(*map(np.atleast_1d, (*each, 0.0))), dtype=float)


_LIKE_THE_STEP = ("step", "at", "position_v", "velocity_a", "velocity", "end_velocity_a", "end_velocity")
_LIKE_ITS_SQUARE = ("position_a", "position", "end_position_a", "end_position")


def step_coefficients(step: float, rho: float) -> StepCoefficients:
    """Coefficients for a step [s] and a spectral radius rho (0 < rho <= 1) at infinite frequency."""
    alpha_m, alpha_f = (2 * rho - 1) / (rho + 1), rho / (rho + 1)
    gamma = 0.5 - alpha_m + alpha_f
    beta = 0.25 * (1 - alpha_m + alpha_f) ** 2
    part = 1 - alpha_f
    return StepCoefficients(
        step=step,
        at=part * step,
        position_v=part * step,
        position_a=part * step**2 * (0.5 - beta),
        position=part * step**2 * beta,
        velocity_a=part * step * (1 - gamma),
        velocity=part * step * gamma,
        acceleration_a=alpha_m,
        acceleration=1 - alpha_m,
        end_position_a=step**2 * (0.5 - beta),
        end_position=step**2 * beta,
        end_velocity_a=step * (1 - gamma),
        end_velocity=step * gamma,
    )


@dataclass(frozen=True)
class StepPlan:
    """Step boundaries [s] [steps + 1], the index of each frame among them [frames], and every step's coefficients."""

    boundaries: np.ndarray
    frames: np.ndarray
    coefficients: list[StepCoefficients]

    @property
    def balance_times(self) -> np.ndarray:
        """Instant [s] in each step at which forces are balanced, [steps]."""
        return np.array(
            [start + c.at for start, c in zip(self.boundaries[:-1], self.coefficients, strict=True)]
        )


def plan_steps(
    frame_times: np.ndarray, steps_per_second: float, rho: float, start: float, end: float
) -> StepPlan:
    """Equal steps, about `steps_per_second` of them, between neighbouring frames [s] and on to `end` [s].

    Frame times come rounded and jitter a little; a tenth of a step too long is not worth another step.
    """
    marks = np.unique(np.concatenate([[start], frame_times, [max(end, frame_times[-1])]]))
    counts = np.maximum(1, np.ceil(np.diff(marks) * steps_per_second - 0.1).astype(int))
    ends = np.cumsum(counts)
    frames = np.concatenate([[0], ends])[np.searchsorted(marks, frame_times)]
    lengths = np.repeat(np.diff(marks) / counts, counts)
    back = np.repeat(ends, counts) - np.arange(1, counts.sum() + 1)
    boundaries = np.concatenate([marks[:1], np.repeat(marks[1:], counts) - back * lengths])
    rounded = np.round(lengths, 10).tolist()
    by_length = {length: step_coefficients(length, rho) for length in set(rounded)}
    return StepPlan(boundaries, frames, [by_length[length] for length in rounded])


@dataclass(frozen=True)
class SolvedStep:
    """A step, or a part of one that had to be divided: the states around it, the motion and the drive in between."""

    before: State
    after: State
    motion: Motion
    drive: DriveState
    coefficients: StepCoefficients

    @staticmethod
    def between(before: State, after: State, drive: DriveState, c: StepCoefficients) -> "SolvedStep":
        """The step that led from a state to the next."""
        motion = balance_motion(before, after.acceleration, c.to_balance)
        return SolvedStep(before, after, motion, drive, c)


def balance_motion(state: State, acceleration: np.ndarray, to_balance: np.ndarray) -> Motion:
    """Motion where forces are balanced for an end-of-step acceleration; to_balance: see `StepCoefficients`."""
    x, v, a = (np.empty_like(acceleration) for _ in range(3))
    lane = lane_tuple(acceleration.shape[-1])
    combine(state.position, state.velocity, state.acceleration, acceleration, to_balance, x, v, a, lane)
    return Motion(x, v, a)
