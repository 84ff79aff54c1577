"""Derivative of the residual by one parameter at a fixed motion, by central differences of only what it changes."""

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np

from hasel_sim.mechanics.force_law import ForceLaw
from hasel_sim.mechanics.linearisation import StrainedSystem
from hasel_sim.mechanics.motion import DriveState, Memory, Motion
from hasel_sim.mechanics.solid import Solid
from hasel_sim.mechanics.state import State
from hasel_sim.mechanics.stress_law import StressLaw
from hasel_sim.mechanics.system import System


class ResidualSlope(Protocol):
    """What the stepper asks of a parameter, in one lane or, by `beside`, in several."""

    def add(
        self,
        motion: Motion,
        drive: DriveState,
        line: StrainedSystem,
        state: State,
        at: float | np.ndarray,
        out: np.ndarray,
        load_factor: float = 1.0,
    ) -> None:
        """Add the derivative of the residual, under a share of all loads, to out [nodes, 2, lanes].

        state: that of the step's start; at: how far into the step forces balance [s]; 0 for statics.
        """

    @staticmethod
    def beside(each: Sequence[Any]) -> "ResidualSlope":
        """The same parameter of several bodies, one lane after the other."""


class NoSlope:
    """A parameter that the mechanics does not see (it acts through the contraction or the observation)."""

    def add(self, motion, drive, line, state, at, out, load_factor=1.0) -> None:
        """Add nothing."""

    @staticmethod
    def beside(each: Sequence["NoSlope"]) -> "NoSlope":
        """None of the bodies sees it."""
        return each[0]


class ContractionSlope:
    """The contraction that a muscle always has, whatever is commanded."""

    def __init__(self, muscle: int) -> None:
        self._muscle = muscle

    def add(self, motion, drive, line, state, at, out, load_factor=1.0) -> None:
        """Add the derivative of the residual by this muscle's contraction."""
        out += line.by_contraction(drive)[self._muscle]

    @staticmethod
    def beside(each: Sequence["ContractionSlope"]) -> "ContractionSlope":
        """The same muscle of every body."""
        return each[0]


class LawSlope:
    """A parameter of one force or stress effect that changes its laws and not where they act."""

    def __init__(self, laws: Sequence[ForceLaw | StressLaw], name: str) -> None:
        self._laws, self._name = laws, name

    def add(self, motion, drive, line, state, at, out, load_factor=1.0) -> None:
        """Add the derivative of the nodal forces out of balance."""
        for law in self._laws:
            law.add_slope(self._name, line, drive, load_factor, out)

    @staticmethod
    def beside(each: Sequence["LawSlope"]) -> "LawSlope":
        """The same parameter of several bodies, one lane after the other."""
        laws: list[ForceLaw | StressLaw] = []
        for beside in zip(*(slope._laws for slope in each), strict=True):
            if isinstance(beside[0], StressLaw):
                laws.append(StressLaw.beside(beside))
            else:
                laws += ForceLaw.beside(beside)
        return LawSlope(laws, each[0]._name)


class ForceSlope:
    """A parameter that moves the sites of a force: its laws for a little more and a little less, the width between."""

    def __init__(self, more: list[ForceLaw], less: list[ForceLaw], width: float | np.ndarray) -> None:
        self._more, self._less, self.width = more, less, np.atleast_1d(width)

    @staticmethod
    def beside(each: Sequence["ForceSlope"]) -> "ForceSlope":
        """Those of several bodies, one lane after the other."""
        more, less = (
            [
                law
                for laws in zip(*(getattr(slope, name) for slope in each), strict=True)
                for law in ForceLaw.beside(laws)
            ]
            for name in ("_more", "_less")
        )
        return ForceSlope(more, less, np.concatenate([slope.width for slope in each]))

    def add(self, motion, drive, line, state, at, out, load_factor=1.0) -> None:
        """Subtract the derivative of the force, which stands on the right-hand side."""
        for laws, sign in ((self._more, 1.0), (self._less, -1.0)):
            for law in laws:
                law.add_force(motion, drive, out, sign * -load_factor / self.width)


class _Difference:
    """Two of a kind, for a little more and a little less of a parameter, and the width between [lanes]."""

    kind: Any

    def __init__(self, more, less, width: float | np.ndarray) -> None:
        self.more, self.less, self.width = more, less, np.atleast_1d(width)

    @classmethod
    def beside(cls, each: Sequence["_Difference"]) -> Any:
        """Those of several bodies, one lane after the other."""
        more, less = (cls.kind.beside([getattr(slope, name) for slope in each]) for name in ("more", "less"))
        return cls(more, less, np.concatenate([slope.width for slope in each]))


class SolidSlope(_Difference):
    """A parameter of the solid's constants, rest shape or branches."""

    kind: Any = Solid

    def __init__(self, more: Solid, less: Solid, width: float | np.ndarray) -> None:
        super().__init__(more, less, width)
        self._same_shape = more.same_shape(less)

    @property
    def solids(self) -> tuple[tuple[Solid, float], tuple[Solid, float]]:
        """The two solids with their signs in the difference."""
        return (self.more, 1.0), (self.less, -1.0)

    def add(self, motion, drive, line, state, at, out, load_factor=1.0) -> None:
        """Add the derivative of the internal force."""
        for solid, sign in self.solids:
            F = line.F if self._same_shape else solid.gradient(motion.position)
            rate = line.rate if self._same_shape else solid.gradient(motion.velocity)
            P = solid.stress(F, rate, drive.contraction, self._history(solid, state, at), at)
            solid.add_force((sign / self.width) * P, out)

    @staticmethod
    def _history(solid: Solid, state: State | None, at: float | np.ndarray) -> np.ndarray | None:
        relaxed = len(solid.branches) == 0 or state is None
        return None if relaxed else solid.branches.history(state.branch, state.green, at)


class SystemSlope(SolidSlope):
    """A parameter that changes everything, such as the outline."""

    kind = System

    def __init__(self, more: System, less: System, width: float | np.ndarray) -> None:
        _Difference.__init__(self, more, less, width)

    @property
    def solids(self) -> tuple[tuple[Solid, float], tuple[Solid, float]]:
        """The two solids with their signs in the difference."""
        return (self.more.solid, 1.0), (self.less.solid, -1.0)

    def add(self, motion, drive, line, state, at, out, load_factor=1.0) -> None:
        """Add the derivative of the whole residual."""
        for system, sign in ((self.more, 1.0), (self.less, -1.0)):
            memory = Memory(self._history(system.solid, state, at), at)
            out += (sign / self.width) * system.residual(motion, drive, memory, load_factor)
