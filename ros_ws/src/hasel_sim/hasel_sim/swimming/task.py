"""What is sought among swimmers: speed or a low cost of transport, straight on or turning."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from hasel_sim.errors import SimulationError
from hasel_sim.swimming.variables import Range

GOALS = ("speed", "cost")


@dataclass(frozen=True)
class Task:
    """What is sought: the fastest swim, or the one with the least cost of transport.

    turning: at a rate [rad/s]; heading: the body points there at the end, to the left of its start [rad]; either as it
    comes for None. vary, ranges: as of `Variables`; largest: voltage [V]; duration: of the swims that are tried [s].
    """

    goal: str = "speed"
    turning: float | None = None
    vary: tuple[str, ...] = ("first", "second")
    largest: float = 5500.0
    duration: float = 4.0
    heading: float | None = None
    ranges: Mapping[str, Range] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.goal not in GOALS:
            raise SimulationError(f"'{self.goal}' is no goal; expected one of {', '.join(GOALS)}")
        if self.turning is not None and self.heading is not None:
            raise SimulationError(
                "both turning and heading are given; expected one of them, since the one sets the other: leave one out"
            )
