"""What a parameter of the model changes in the residual at a fixed motion: descriptions, which `residual_columns` does.

A parameter of an effect's law is differentiated as the law was recorded; everything else by central differences of only
what it changes: the solid, the whole system or the sites of a force, for a little more and a little less of it.
"""

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np

from hasel_sim.mechanics.force_law import ForceLaw
from hasel_sim.mechanics.solid import Solid
from hasel_sim.mechanics.stress_law import StressLaw


class ResidualSlope(Protocol):
    """Derivative of the residual by one parameter, of one lane or, by `beside`, of several."""

    @staticmethod
    def beside(each: Sequence[Any]) -> "ResidualSlope":
        """The same parameter of several bodies, one lane after the other."""


class NoSlope:
    """A parameter that the mechanics does not see (it acts through the contraction or the observation)."""

    @staticmethod
    def beside(each: Sequence["NoSlope"]) -> "NoSlope":
        """None of the bodies sees it."""
        return each[0]


class ContractionSlope:
    """The contraction that a muscle always has, whatever is commanded; muscle: its number."""

    def __init__(self, muscle: int) -> None:
        self.muscle = muscle

    @staticmethod
    def beside(each: Sequence["ContractionSlope"]) -> "ContractionSlope":
        """The same muscle of every body."""
        return each[0]


class LawSlope:
    """A parameter of one force or stress effect that changes its laws and not where they act.

    by_difference: the same of a force, should its sites move in another lane.
    """

    def __init__(
        self,
        laws: Sequence[ForceLaw | StressLaw],
        name: str,
        by_difference: "ForceSlope | None" = None,
    ) -> None:
        self.laws, self.name, self.by_difference = laws, name, by_difference

    @staticmethod
    def beside(each: Sequence["LawSlope"]) -> "LawSlope":
        """The same parameter of several bodies, one lane after the other."""
        laws: list[ForceLaw | StressLaw] = []
        for beside in zip(*(slope.laws for slope in each), strict=True):
            if isinstance(beside[0], StressLaw):
                laws.append(StressLaw.beside(beside))
            else:
                laws += ForceLaw.beside(beside)
        return LawSlope(laws, each[0].name)


class _Difference:
    """Two of a kind, for a little more and a little less of a parameter, and the width between [lanes]."""

    def __init__(self, more, less, width: float | np.ndarray) -> None:
        self.more, self.less, self.width = more, less, np.atleast_1d(width)

    @classmethod
    def beside(cls, each: Sequence["_Difference"]) -> Any:
        """Those of several bodies, one lane after the other."""
        more, less = (cls._joined([getattr(slope, name) for slope in each]) for name in ("more", "less"))
        return cls(more, less, np.concatenate([slope.width for slope in each]))

    @staticmethod
    def _joined(each: list) -> Any:
        return type(each[0]).beside(each)

    @property
    def signed(self) -> tuple[tuple[Any, np.ndarray], ...]:
        """Both, with their factors [lanes] in the difference."""
        return (self.more, 1.0 / self.width), (self.less, -1.0 / self.width)


class ForceSlope(_Difference):
    """A parameter that moves the sites of a force: its laws for a little more and a little less of it."""

    @staticmethod
    def _joined(each: list) -> list[ForceLaw]:
        return [law for laws in zip(*each, strict=True) for law in ForceLaw.beside(laws)]


class SolidSlope(_Difference):
    """A parameter of the solid's constants, rest shape or branches; more, less: `Solid`."""

    @property
    def solids(self) -> tuple[tuple[Solid, np.ndarray], ...]:
        """The two solids with their factors [lanes] in the difference."""
        return self.signed


class SystemSlope(_Difference):
    """A parameter that changes everything, such as the outline; more, less: `System`."""

    @property
    def solids(self) -> tuple[tuple[Solid, np.ndarray], ...]:
        """The solids of the two systems with their factors [lanes] in the difference."""
        return tuple((system.solid, factor) for system, factor in self.signed)


def solids_of(parameter: ResidualSlope) -> tuple[tuple[Solid, np.ndarray], ...]:
    """The solids that a parameter changes, with their factors [lanes] in its difference; none of another kind."""
    return parameter.solids if isinstance(parameter, SolidSlope | SystemSlope) else ()


def beside(each: Sequence[Any]) -> Any:
    """The same parameter of several bodies, one lane after the other, some of which it may not move the sites of."""
    if any(isinstance(slope, ForceSlope) for slope in each):
        each = [slope.by_difference if isinstance(slope, LawSlope) else slope for slope in each]
    return type(each[0]).beside(each)
