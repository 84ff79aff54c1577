"""The forward pass, with everything kept that the way back needs."""

from dataclasses import dataclass

import numpy as np

from hasel_sim.mechanics.initial import initial_state
from hasel_sim.mechanics.motion import DriveState
from hasel_sim.mechanics.state import State
from hasel_sim.observation import observe
from hasel_sim.prepared_run import PreparedRun


@dataclass(frozen=True)
class Trajectory:
    """States at the step boundaries [steps + 1], the drive at every balance [steps], and what the camera sees.

    markers and lines across the body through them: [steps + 1, 3, 2].
    """

    prepared: PreparedRun
    states: list[State]
    drives: list[DriveState]
    markers: np.ndarray
    lines: np.ndarray

    @property
    def series(self) -> np.ndarray:
        """The measured sin theta at the step boundaries, [steps + 1]."""
        values = self.prepared.model.effect_values()
        time = self.prepared.plan.boundaries
        return observe(time, self.markers, self.lines, self.prepared.observed_by, values)


def follow(prepared: PreparedRun, contraction: np.ndarray) -> Trajectory:
    """Step through a run driven by contractions [steps, 2] at the balance times."""
    stepper, drives = prepared.stepper, prepared.drives(contraction)
    state, _ = initial_state(
        stepper.system, prepared.start_drive, prepared.load_factor, [], prepared.held_shape
    )
    states = [state]
    for drive, c in zip(drives, prepared.plan.coefficients, strict=True):
        states.append(stepper.step(states[-1], drive, c)[0])
    markers, lines = prepared.rows(np.array([state.position for state in states]))
    return Trajectory(prepared, states, drives, markers, lines)
