"""What the driver checks in every report of a supply: one row each, with how long it is borne and why."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from hasel_driver.faults import FaultCode
from hasel_driver.ground import Ground
from hasel_driver.limits import Limits
from hasel_driver.mode import Mode
from hasel_driver.supply import Reading

STALE_S = 0.2
TRANSITION_S = 0.3  # time the board has to follow a request
PROOF_S = 0.9  # for the test pulse of arming
GROUND_S = 0.3  # a supply that should be grounded, and is not
ABOVE_MAXIMUM_S = 0.2  # after the maximum was lowered, muscles discharge first
HOST_TRIP_S = 0.05  # the board's own trips come first


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
    Check(
        FaultCode.NO_TELEMETRY,
        _no_telemetry,
        _for(0.0),
        "what is not reported is not known",
    ),
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
