"""What proves the virtual board's ground contacts, as in `firmware/hasel_supply/ground_*.cpp`."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum

from hasel_driver.limits import DISCHARGED_V, PULSE_V

GROUND_PROOF_MS = 100  # a closed ground contact must have discharged its muscle by then
LEAK_MS = 20  # with nothing connected, to see what leaks away by itself
CHARGE_MS = 250
LEAST_FALL_V = 2 * DISCHARGED_V  # from which a muscle grounded in use proves its contact anew
LEAST_FORECAST_V = 20.0  # two steps of the monitor: where leakage leaves less, nothing is proven


@dataclass
class GroundEvidence:
    """One channel's: its voltage fell faster than leakage alone would have let it."""

    proven: bool = False
    kept: float = 1.0  # share of its voltage that a muscle keeps for LEAK_MS with nothing connected
    _was_closed: bool = True
    _falling_ms: int | None = None
    _below_v: float = 0.0
    _leaked_v: float = 0.0  # that leakage alone would leave

    def step(self, closed: bool, measured_v: float, least_v: float) -> None:
        """One millisecond; a fall counts if it begins at `least_v` or more as the contact closes."""
        if not closed:
            self.proven, self._was_closed, self._falling_ms = False, False, None
            return
        if not self._was_closed:
            self._was_closed = True
            self._falling_ms = 0 if measured_v >= least_v else None
            self._below_v = min(DISCHARGED_V, measured_v * 0.4)
            self._leaked_v = measured_v * self.kept
        if self._falling_ms is None:
            return
        self._falling_ms += 1
        if measured_v < self._below_v and measured_v <= self._leaked_v / 2:
            self.proven, self._falling_ms = True, None
        elif self._falling_ms >= GROUND_PROOF_MS or self._leaked_v < LEAST_FORECAST_V:
            self._falling_ms = None
        elif self._falling_ms % LEAK_MS == 0:
            self._leaked_v *= self.kept


class GroundVerdict(Enum):
    """How far the test pulse is."""

    RUNNING = 0
    PROVEN = 1
    NOT_CHARGED = 2
    NOT_GROUNDED = 3


@dataclass
class GroundProof:
    """The test pulse of every arming: charge both muscles, let go, and see the ground contacts discharge them."""

    pulse_v: float = PULSE_V
    _phase: str = "charge"
    _phase_ms: int = 0
    _charged_v: tuple[float, ...] = field(default=(0.0, 0.0))
    _kept_v: tuple[float, ...] = field(default=(0.0, 0.0))

    @property
    def wanted_v(self) -> float:
        """What both channels are to have [V]."""
        return self.pulse_v if self._phase == "charge" else 0.0

    def step(
        self, measured_v: Sequence[float], closed: bool, evidence: Sequence[GroundEvidence]
    ) -> GroundVerdict:
        """One millisecond; `closed`: both ground contacts. The leakage that is seen goes into `evidence`."""
        self._phase_ms += 1
        if self._phase == "charge":
            if min(measured_v) >= 0.8 * self.pulse_v:
                self._charged_v = self._kept_v = tuple(measured_v)
                self._begin("let go")
            return GroundVerdict.NOT_CHARGED if self._phase_ms > CHARGE_MS else GroundVerdict.RUNNING
        if self._phase == "let go":
            self._see_leakage(measured_v, closed, evidence)
            if closed:
                self._begin("ground")
            return GroundVerdict.NOT_GROUNDED if self._phase_ms > CHARGE_MS else GroundVerdict.RUNNING
        if all(each.proven for each in evidence):
            return GroundVerdict.PROVEN
        return GroundVerdict.NOT_GROUNDED if self._phase_ms > GROUND_PROOF_MS else GroundVerdict.RUNNING

    def _begin(self, phase: str) -> None:
        self._phase, self._phase_ms = phase, 0

    def _see_leakage(
        self, measured_v: Sequence[float], closed: bool, evidence: Sequence[GroundEvidence]
    ) -> None:
        if not closed:
            self._kept_v = tuple(measured_v)
        for each, kept_v, charged_v in zip(evidence, self._kept_v, self._charged_v, strict=True):
            each.kept = min(1.0, kept_v / charged_v)
