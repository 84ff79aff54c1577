"""A step that was made."""

from dataclasses import dataclass

import numpy as np

from hasel_sim.mechanics.generalised_alpha import StepCoefficients
from hasel_sim.mechanics.lane_loops import combine
from hasel_sim.mechanics.motion import DriveState, Motion
from hasel_sim.mechanics.state import State
from hasel_sim.simd import lane_tuple


@dataclass(frozen=True)
class Part:
    """A step, or a part of one that had to be divided: the states around it, the motion and the drive in between."""

    before: State
    after: State
    motion: Motion
    drive: DriveState
    coefficients: StepCoefficients

    @staticmethod
    def between(before: State, after: State, drive: DriveState, c: StepCoefficients) -> "Part":
        """The step that led from a state to the next."""
        motion = balance_motion(before, after.acceleration, c.to_balance)
        return Part(before, after, motion, drive, c)


def balance_motion(state: State, acceleration: np.ndarray, to_balance: np.ndarray) -> Motion:
    """Motion where forces are balanced for an end-of-step acceleration; to_balance: see `StepCoefficients`."""
    x, v, a = (np.empty_like(acceleration) for _ in range(3))
    lane = lane_tuple(acceleration.shape[-1])
    combine(state.position, state.velocity, state.acceleration, acceleration, to_balance, x, v, a, lane)
    return Motion(x, v, a)
