"""Whether a message follows the ones before it in time."""

from dataclasses import dataclass
from enum import Enum


class Arrival(Enum):
    """What a message's stamp means for the simulation."""

    START = "start"
    NEXT = "next"
    GAP = "gap"
    HELD = "held"
    RESTART = "restart"


@dataclass(frozen=True)
class StampVerdict:
    """What to do with a message, and a sentence when that is out of the ordinary (else empty)."""

    arrival: Arrival
    sentence: str = ""


class StampOrder:
    """Compares each stamp [ns] with the newest one accepted.

    gap: messages further apart [s] than this count as missing; the body moves on under the voltage held.
    reset: a longer gap [s] begins a new run; late: so does a message older than the newest by more than this [s].
    """

    def __init__(self, gap: float, reset: float, late: float) -> None:
        self.gap, self.reset, self.late = gap, reset, late
        self._newest: int | None = None

    def forget(self) -> None:
        """Let the next message begin a new run."""
        self._newest = None

    def judge(self, stamp_ns: int) -> StampVerdict:
        """Accept a stamp, or hold on to the newest one."""
        newest = self._newest
        if newest is None:
            self._newest = stamp_ns
            return StampVerdict(Arrival.START)
        step = (stamp_ns - newest) * 1e-9
        if not -self.late <= step <= self.reset:
            self._newest = stamp_ns
            return StampVerdict(
                Arrival.RESTART, f"the stamps jumped by {step:+.3g} s: a new run starts from rest"
            )
        if step <= 0:
            what = "came twice" if step == 0 else f"is {-step:.3g} s older than the newest"
            return StampVerdict(Arrival.HELD, f"a state message {what}: it is ignored and the body held")
        self._newest = stamp_ns
        if step > self.gap:
            return StampVerdict(
                Arrival.GAP,
                f"no state message for {step:.3g} s, expected one every {self.gap:g} s: the last voltage was held",
            )
        return StampVerdict(Arrival.NEXT)
