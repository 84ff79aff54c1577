# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What the driver checks in every report of a supply: one row each, with how long it is borne and why."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from hasel_driver.protocol.faults import FaultCode
from hasel_driver.protocol.limits import MUSCLE_NAMES, Limits
from hasel_driver.protocol.status import Ground, Mode
from hasel_driver.supplies.supply import Reading

LEAST_FOLLOWED_V = 400.0  # of what is asked for, below which a monitor tells too little
LOW_S = 0.2  # below half of what is asked for, or of the wrong sign, for so long
STUCK_S = 0.35  # at one value for so long, while what is asked for has changed by MOVED_V
STUCK_V, MOVED_V = 20.0, 500.0
FOLLOWED_SHARE = 0.85  # a monitor that is out by more is refused by `calibrate`, too
REVERSAL_S = 0.2  # dead times and discharge of a change of polarity
LONGEST_STEP_S = 0.05  # what lies between two reports further apart is not known
STALE_S = 0.2
TRANSITION_S = 0.3  # time the board has to follow a request
PROOF_S = 0.9  # for the test pulse of arming
GROUND_S = 0.3  # a supply that should be grounded, and is not
ABOVE_MAXIMUM_S = 0.2  # after the maximum was lowered, muscles discharge first
HOST_TRIP_S = 0.05  # the board's own trips come first


@dataclass
class MonitorWatch:
    """Whether one channel's measured voltage follows what was asked for: a blind monitor proves nothing.

    Fed with magnitudes, in the sign of what is asked for, while the source is connected; as in the firmware.
    """

    _low_s: float = 0.0
    _stuck_v: float = 0.0
    _anchor_v: float = 0.0  # asked for when the measured voltage moved last
    _risen_s: float = 0.0  # for which it should have risen
    _fallen_s: float = 0.0  # and fallen, without a break: no converter sinks, a ripple need not be followed

    def step(self, asked_v: float, reached_v: float, measured_v: float, duration_s: float) -> str | None:
        """What is wrong with `measured_v`, when `asked_v` was in force for `duration_s`; or None.

        reached_v: at least so much the output must have by now, through slew limit and reversals.
        """
        if reached_v >= LEAST_FOLLOWED_V:
            self._low_s = self._low_s + duration_s if measured_v < reached_v / 2 else 0.0
        if abs(measured_v - self._stuck_v) > STUCK_V:
            self._stuck_v, self._anchor_v = measured_v, asked_v
            self._risen_s = self._fallen_s = 0.0
        if asked_v >= self._anchor_v + MOVED_V and self._stuck_v <= FOLLOWED_SHARE * asked_v:
            self._risen_s += duration_s
        self._fallen_s = self._fallen_s + duration_s if asked_v <= self._anchor_v - MOVED_V else 0.0
        if self._low_s >= LOW_S:
            return f"{measured_v:.0f} V are measured where {asked_v:.0f} V are asked for"
        if max(self._risen_s, self._fallen_s) >= STUCK_S:
            return f"{measured_v:.0f} V are measured still, {self._anchor_v:.0f} V became {asked_v:.0f} V"
        return None


class OutputWatch:
    """Both channels of a supply, by its reports: what was asked for, as the slew limit lets it rise, and measured."""

    def __init__(self) -> None:
        self._time_s: float | None = None
        self.restart()

    def restart(self) -> None:
        """The output begins at 0 V again, as after the maximum was lowered."""
        self._watches = (MonitorWatch(), MonitorWatch())
        self._signs = [0, 0]
        self._reached_v = [0.0, 0.0]
        self._pauses_s = [0.0, 0.0]

    def take(self, reading: Reading, slew_v_per_ms: float) -> str | None:
        """What is wrong with the monitors by the reports so far."""
        last_s, self._time_s = self._time_s, reading.time_s
        duration_s = 0.0 if last_s is None else min(max(reading.time_s - last_s, 0.0), LONGEST_STEP_S)
        found = [
            self._step(channel, reading, slew_v_per_ms * 1e3 * duration_s, duration_s) for channel in range(2)
        ]
        return next((text for text in found if text), None)

    def _step(self, channel: int, reading: Reading, rise_v: float, duration_s: float) -> str | None:
        asked_v, measured_v = reading.commanded_v[channel], reading.measured_v[channel]
        sign = (asked_v > 0) - (asked_v < 0) if reading.mode is Mode.ACTIVE else 0
        if sign != self._signs[channel] or (reading.ground or Ground.NOT) is not Ground.NOT:
            self._signs[channel], self._reached_v[channel] = sign, 0.0
            self._pauses_s[channel] = REVERSAL_S
        if not sign or math.isnan(measured_v):
            return None
        self._pauses_s[channel] -= duration_s
        if self._pauses_s[channel] <= 0:
            self._reached_v[channel] = min(abs(asked_v), self._reached_v[channel] + rise_v)
        reached_v = self._reached_v[channel]
        wrong = self._watches[channel].step(abs(asked_v), reached_v, sign * measured_v, duration_s)
        return wrong and f"{MUSCLE_NAMES[channel]} muscle: {wrong}"


@dataclass(frozen=True)
class Sight:
    """What the checks look at, at one moment."""

    reading: Reading | None  # None: the last is older than STALE_S
    limits: Limits
    armed: bool  # high voltage was asked for and not withdrawn
    proving: bool  # armed, and the test pulse has not ended yet
    asked_s: float  # since a change of mode was last asked for
    unfollowed: str | None  # how the measured voltage does not follow what was asked for


@dataclass(frozen=True)
class Check:
    """`found` says what is wrong, or None; it becomes the fault `code` when it was wrong for `patience_s`."""

    code: FaultCode
    found: Callable[[Sight], str | None]
    patience_s: Callable[[Sight], float]
    why: str


def _no_telemetry(sight: Sight) -> str | None:
    return None if sight.reading else f"none for {STALE_S:g} s"


def _unexpected(sight: Sight) -> str | None:
    reading = sight.reading
    if reading is None or reading.mode.may_be_live == sight.armed or sight.asked_s <= TRANSITION_S:
        return None
    return f"{reading.mode.name}, {'armed' if sight.armed else 'disarmed'} was asked for"


def _unproven(sight: Sight) -> str | None:
    reading = sight.reading
    if reading is None or reading.ground is not Ground.NOT:
        return None
    idle = reading.mode is Mode.STANDBY or not any(reading.commanded_v)
    return f"{volts(reading.measured_v)} measured" if idle else None


def _ground_patience_s(sight: Sight) -> float:
    if sight.proving:
        return PROOF_S
    live = sight.reading is not None and sight.reading.mode.may_be_live
    return GROUND_S + (sight.limits.maximum_voltage_v / sight.limits.slew_v_per_ms * 1e-3 if live else 0.0)


def _above(sight: Sight) -> str | None:
    reading, maximum_v = sight.reading, sight.limits.maximum_voltage_v
    if reading is None or not max(map(abs, reading.measured_v)) > max(1.05 * maximum_v, maximum_v + 100.0):
        return None
    return f"{volts(reading.measured_v)}, {maximum_v:g} V is allowed"


def _over_current(sight: Sight) -> str | None:
    trip_a = sight.limits.trip_current_a
    if sight.reading is None or not max(sight.reading.current_a) > 1.05 * trip_a + 20e-6:
        return None
    return f"the board reports {max(sight.reading.current_a) * 1e6:.0f} µA and did not trip at {trip_a * 1e6:.0f} µA"


def _open_interlock(sight: Sight) -> str | None:
    reading = sight.reading
    if (
        not sight.armed
        or reading is None
        or reading.interlock_closed is None
        or all(reading.interlock_closed)
    ):
        return None
    return "the board reports it open, and stays armed"


def _for(duration_s: float) -> Callable[[Sight], float]:
    return lambda sight: duration_s


CHECKS: tuple[Check, ...] = (
    Check(FaultCode.NO_TELEMETRY, _no_telemetry, _for(0.0), "what is not reported is not known"),
    Check(
        FaultCode.UNEXPECTED_STATE, _unexpected, _for(0.0), "nothing arms by itself, and nothing stays armed"
    ),
    Check(
        FaultCode.GROUND_NOT_PROVEN,
        _unproven,
        _ground_patience_s,
        "a muscle that should be grounded and is charged is the worst of all states",
    ),
    Check(FaultCode.ABOVE_MAXIMUM, _above, _for(ABOVE_MAXIMUM_S), "the board's own limit may be wrong"),
    Check(
        FaultCode.MONITOR,
        lambda sight: sight.unfollowed,
        _for(0.0),
        "a blind monitor calls everything grounded",
    ),
    Check(FaultCode.OVERCURRENT, _over_current, _for(HOST_TRIP_S), "the board's own trip may not work"),
    Check(FaultCode.INTERLOCK, _open_interlock, _for(HOST_TRIP_S), "the board's own interlock may not work"),
)


class Watch:
    """Applies the table; remembers since when each row was wrong."""

    def __init__(self) -> None:
        self._since_s: dict[FaultCode, float] = {}

    def forget(self) -> None:
        """Begin anew: another board may be there."""
        self._since_s.clear()

    def look(self, sight: Sight, now_s: float) -> tuple[FaultCode, str] | None:
        """The first row whose patience has ended, and what it found."""
        for check in CHECKS:
            detail = check.found(sight)
            if detail is None:
                self._since_s.pop(check.code, None)
            elif now_s - self._since_s.setdefault(check.code, now_s) >= check.patience_s(sight):
                return check.code, detail
        return None


def volts(voltage_v: tuple[float, float]) -> str:
    """In words."""
    return " and ".join("unknown" if math.isnan(each) else f"{each:.0f}" for each in voltage_v) + " V"
