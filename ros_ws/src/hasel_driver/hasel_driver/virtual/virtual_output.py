# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Output stage of the virtual supply: muscles, contacts that break before they make, and what proves the ground."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from hasel_driver.protocol.limits import DISCHARGED_V, PULSE_V

GROUND_PROOF_MS = 100  # a closed ground contact must have discharged its muscle by then
LEAK_MS = 20  # with nothing connected, to see what leaks away by itself
CHARGE_MS = 250
LEAST_FALL_V = 2 * DISCHARGED_V  # from which a muscle grounded in use proves its contact anew
LEAST_FORECAST_V = 20.0  # two steps of the monitor: where leakage leaves less, nothing is proven


class Contact(Enum):
    """What the output stage connects the muscle to."""

    GROUND = 0
    OPEN = 1
    POSITIVE = 2
    NEGATIVE = 3

    @property
    def sign(self) -> int:
        """Polarity of the source, 0 where it is not connected."""
        return {Contact.POSITIVE: 1, Contact.NEGATIVE: -1}.get(self, 0)


@dataclass
class VirtualMuscle:
    """A capacitor with leakage behind a converter that can source but not sink current."""

    capacitance_f: float = 0.5e-9
    leakage_ohm: float = 1e9
    ground_ohm: float = 2e6
    current_limit_a: float = 500e-6  # 5 W at 10 kV
    short_ohm: float = math.inf  # injected fault
    voltage_v: float = 0.0
    current_a: float = 0.0

    def step(self, duration_s: float, contact: Contact, set_point_v: float) -> None:
        """Advance by `duration_s` with the converter's magnitude at `set_point_v` [V]."""
        parallel_ohm = 1.0 / (1.0 / self.leakage_ohm + 1.0 / self.short_ohm)
        if contact is Contact.GROUND:
            parallel_ohm = 1.0 / (1.0 / parallel_ohm + 1.0 / self.ground_ohm)
        decay = math.exp(-duration_s / (parallel_ohm * self.capacitance_f))
        rest_v = self.voltage_v * decay
        self.current_a = 0.0
        if contact.sign:
            # Voltage that a constant current adds within the step is current × gain.
            gain_ohm = parallel_ohm * (1.0 - decay)
            wanted_a = (set_point_v - contact.sign * rest_v) / gain_ohm
            self.current_a = min(max(wanted_a, 0.0), self.current_limit_a)
            rest_v += contact.sign * self.current_a * gain_ohm
        self.voltage_v = rest_v


@dataclass
class VirtualBridge:
    """Moves contacts and set point towards a wanted voltage, one millisecond at a time."""

    contact: Contact = Contact.GROUND
    set_point_v: float = 0.0
    _dwell_ms: int = 0  # ticks in the present contact, the first of which may be cut short
    _opened_from: Contact = Contact.GROUND

    @property
    def grounded(self) -> bool:
        """Whether the ground contact is closed."""
        return self.contact is Contact.GROUND

    def release(self) -> None:
        """Cut the set point and open the source at once; the ground contact follows after the dead time."""
        self.set_point_v = 0.0
        if self.contact.sign:
            self._move(Contact.OPEN)

    def step(self, wanted_v: float, slew_v: float, measured_v: float, dead_time_ms: int) -> None:
        """One millisecond towards `wanted_v` [V], the set point moving by at most `slew_v` [V]."""
        self._dwell_ms += 1
        polarity = Contact.POSITIVE if wanted_v > 0 else Contact.NEGATIVE if wanted_v < 0 else Contact.GROUND
        if self.contact is Contact.OPEN:
            if self._dwell_ms > dead_time_ms:
                # A source that was just opened is followed by ground, never by the other source.
                self._move(Contact.GROUND if self._opened_from.sign else polarity)
        elif self.contact is Contact.GROUND:
            discharged = abs(measured_v) < DISCHARGED_V
            if polarity is not Contact.GROUND and discharged and self._dwell_ms > dead_time_ms:
                self._move(Contact.OPEN)
        elif self.contact is polarity:
            change = abs(wanted_v) - self.set_point_v
            self.set_point_v += min(max(change, -slew_v), slew_v)
        elif self.set_point_v > slew_v:
            self.set_point_v -= slew_v
        else:
            self.release()

    def _move(self, contact: Contact) -> None:
        self._opened_from, self.contact, self._dwell_ms = self.contact, contact, 0


@dataclass
class GroundEvidence:
    """One channel's: its voltage fell faster than leakage alone would have let it; as in the firmware."""

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
    _charged_v: tuple[float, ...] = (0.0, 0.0)
    _kept_v: tuple[float, ...] = (0.0, 0.0)

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
