"""Derivative of the residual by one parameter at a fixed motion, by central differences of only what it changes."""

from typing import Protocol

import numpy as np

from hasel_sim.mechanics.force_law import ForceLaw
from hasel_sim.mechanics.motion import DriveState, Memory, Motion
from hasel_sim.mechanics.solid import Solid
from hasel_sim.mechanics.state import State
from hasel_sim.mechanics.stress_law import StressLaw
from hasel_sim.mechanics.system import Linearisation, System


class ResidualSlope(Protocol):
    """What the stepper asks of a parameter."""

    def add(
        self,
        motion: Motion,
        drive: DriveState,
        line: Linearisation,
        state: State,
        at: float,
        out: np.ndarray,
        load_factor: float = 1.0,
    ) -> None:
        """Add the derivative of the residual, under a share of all loads, to out [nodes, 2].

        state: that of the step's start; at: how far into the step forces balance [s]; 0 for statics.
        """


class NoSlope:
    """A parameter that the mechanics does not see (it acts through the contraction or the observation)."""

    def add(self, motion, drive, line, state, at, out, load_factor=1.0) -> None:
        """Add nothing."""


class ContractionSlope:
    """The contraction that a muscle always has, whatever is commanded."""

    def __init__(self, muscle: int) -> None:
        self._muscle = muscle

    def add(self, motion, drive, line, state, at, out, load_factor=1.0) -> None:
        """Add the derivative of the residual by this muscle's contraction."""
        out += line.by_contraction(drive)[self._muscle]


class ForceSlope:
    """A parameter of one force effect."""

    def __init__(self, more: ForceLaw, less: ForceLaw, width: float) -> None:
        self._more, self._less, self._width = more, less, width
        self._same_sites = more.sites.same_as(less.sites)

    def add(self, motion, drive, line, state, at, out, load_factor=1.0) -> None:
        """Subtract the derivative of the force, which stands on the right-hand side."""
        factor = -load_factor / self._width
        if self._same_sites:
            self._more.add_excess(self._less, motion, drive, out, factor)
        else:
            self._more.add_force(motion, drive, out, factor)
            self._less.add_force(motion, drive, out, -factor)


class StressSlope:
    """A parameter of one additional stress."""

    def __init__(self, more: StressLaw, less: StressLaw, width: float) -> None:
        self._more, self._less, self._width = more, less, width

    def add(self, motion, drive, line, state, at, out, load_factor=1.0) -> None:
        """Add the nodal forces of the stress's derivative."""
        P = np.zeros_like(line.F)
        change = self._more.stress(line.F, line.rate, drive) - self._less.stress(line.F, line.rate, drive)
        P[self._more.elements] = change / self._width
        line.system.solid.add_force(P, out)


class SolidSlope:
    """A parameter of the solid's constants, rest shape or branches."""

    def __init__(self, more: Solid, less: Solid, width: float) -> None:
        self.more, self.less, self.width = more, less, width
        self._same_shape = np.array_equal(more.gradients, less.gradients)

    def add(self, motion, drive, line, state, at, out, load_factor=1.0) -> None:
        """Add the derivative of the internal force."""
        for solid, sign in ((self.more, 1.0), (self.less, -1.0)):
            F = line.F if self._same_shape else solid.gradient(motion.position)
            rate = line.rate if self._same_shape else solid.gradient(motion.velocity)
            P = solid.stress(F, rate, drive.contraction, self._history(solid, state, at), at)
            solid.add_force((sign / self.width) * P, out)

    @staticmethod
    def _history(solid: Solid, state: State, at: float) -> np.ndarray | None:
        relaxed = len(solid.branches) == 0 or at == 0.0
        return None if relaxed else solid.branches.history(state.branch, state.green, at)


class SystemSlope(SolidSlope):
    """A parameter that changes everything, such as the outline."""

    def __init__(self, more: System, less: System, width: float) -> None:
        super().__init__(more.solid, less.solid, width)
        self._systems = more, less

    def add(self, motion, drive, line, state, at, out, load_factor=1.0) -> None:
        """Add the derivative of the whole residual."""
        for system, sign in zip(self._systems, (1.0, -1.0), strict=True):
            memory = Memory(self._history(system.solid, state, at), at)
            out += (sign / self.width) * system.residual(motion, drive, memory, load_factor)
