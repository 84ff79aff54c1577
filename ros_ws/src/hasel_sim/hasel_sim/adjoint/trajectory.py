"""The forward pass, with everything kept that the way back needs."""

from dataclasses import dataclass

import numpy as np

from hasel_sim.mechanics.initial import initial_state
from hasel_sim.mechanics.state import State
from hasel_sim.mechanics.stepper import Part
from hasel_sim.model_mesh import observe
from hasel_sim.prepared_run import PreparedRun


@dataclass(frozen=True)
class Trajectory:
    """The first state, every step in the parts it was followed in, and what the camera sees.

    shapes: nodal positions [m] [steps + 1, nodes, 2]; markers and lines across the body through them:
    [steps + 1, 3, 2].
    """

    prepared: PreparedRun
    start: State
    steps: list[list[Part]]
    shapes: np.ndarray
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
    stepper.start(state, prepared.start_drive)
    positions, steps, start = [state.position[..., 0]], [], state
    for drive, c in zip(drives, prepared.plan.coefficients, strict=True):
        steps.append(stepper.follow(state, drive, c))
        state = steps[-1][-1].after
        positions.append(state.position[..., 0])
    shapes = np.array(positions)
    return Trajectory(prepared, start, steps, shapes, *prepared.rows(shapes))
