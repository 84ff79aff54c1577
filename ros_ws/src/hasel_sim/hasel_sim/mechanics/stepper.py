"""One time step of a single body, divided where it has to be."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.generalised_alpha import StepCoefficients
from hasel_sim.mechanics.marcher import Drives, Marcher
from hasel_sim.mechanics.motion import DriveState, Motion
from hasel_sim.mechanics.part import Part
from hasel_sim.mechanics.residual_slopes import ResidualSlope
from hasel_sim.mechanics.seen import Seen
from hasel_sim.mechanics.state import State, StateSlopes
from hasel_sim.mechanics.system import System

_MOST_HALVINGS = 8
"""A step that cannot be followed is halved up to this often: to 1/256 of its length."""
_NO_MARKERS = np.zeros((0, 8), dtype=np.intp)
Derivatives = tuple[StateSlopes, np.ndarray]
"""Of a state by parameters, and of the contraction [columns, muscles]."""


class Stepper:
    """Advances a `System` of one lane by generalised-alpha steps.

    tolerance: see `Marcher`; parameters: those by which the motion is differentiated.
    """

    def __init__(self, system: System, tolerance: float, parameters: Sequence[ResidualSlope] = ()) -> None:
        self.system, self.tolerance, self.parameters = system, tolerance, parameters
        self.marcher: Marcher | None = None
        self.jerk: np.ndarray | None = None
        self.stress: np.ndarray | None = None

    def start(self, state: State, drive: DriveState) -> None:
        """Set off from a first state, with the drive it is in equilibrium with."""
        motion = Motion(state.position, state.velocity, state.acceleration)
        stress = self.system.second_piola(motion, drive, self.system.memory(state))
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
    ) -> list[Part]:
        """Make a step of a single lane, in as few parts as it can be followed in; the contraction holds throughout.

        derivatives: of the state by the parameters, brought to the step's end in place, and of the contraction
        [columns, muscles]. Raises SimulationError where even the smallest part fails.
        """
        part = self.step(state, drive, c, derivatives)
        if part is not None:
            return [part]
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
    ) -> Part | None:
        """Make a step of a single lane; None where it is not found."""
        if self.marcher is None:
            self.marcher = Marcher(self.system, self.tolerance, self.parameters)
        if self.jerk is None or self.stress is None:
            self.start(state, drive)
        marcher, after = self.marcher, state.copy()
        drives = Drives(drive.voltage[None], drive.contraction[None], drive.time[None])
        slopes, by_contraction = derivatives or _no_derivatives(state, self.system.muscles)
        marcher.begin(after, self.stress, self.jerk)
        marcher.plan(
            drives,
            np.zeros(1, dtype=int),
            [c],
            np.ones(1, dtype=int),
            Seen.of(_NO_MARKERS, 2, state, len(self.parameters), False),
            slopes,
            by_contraction[None, ..., None],
        )
        found = marcher.advance(0, 1) == 1
        return Part.between(state, after, drive, c) if found else None


def _no_derivatives(state: State, muscles: int) -> Derivatives:
    none = np.zeros((0, *state.position.shape))
    return StateSlopes(none, none, none), np.zeros((0, muscles))
