"""ROS messages from the driver's own data."""

import math
import time
from collections.abc import Sequence

from builtin_interfaces.msg import Time
from hasel_common.diagnostics import Level
from hasel_interfaces.msg import SupplyState

from hasel_driver.ground import Ground
from hasel_driver.limits import MUSCLE_NAMES, Limits
from hasel_driver.mode import Mode
from hasel_driver.status import SupplyStatus

OUTPUT_WORDS = {
    "grounded": "The supply reports its output grounded, and has proven it; stored charge needs its bleeder's time.",
    "commanded": "The output is commanded to ground, not proven: treat it as live.",
    "live": "The supply does not report its output grounded: treat it as live.",
    "unknown": "Nothing proves the output grounded: treat it as live.",
}


def to_time(monotonic_s: float) -> Time:
    """The system time at which the monotonic clock showed `monotonic_s`."""
    nanoseconds = time.time_ns() + int((monotonic_s - time.monotonic()) * 1e9)
    return Time(sec=nanoseconds // 1_000_000_000, nanosec=nanoseconds % 1_000_000_000)


def to_supply_state(
    status: SupplyStatus,
    limits: Limits | None = None,
    holders: Sequence[str] = (),
    frame_id: str = "",
    commander: str = "",
) -> SupplyState:
    """`/hasel/state`; in FAULT its text also tells whether the output is proven grounded, else why it disarmed."""
    message = SupplyState()
    message.header.stamp, message.header.frame_id = to_time(status.time_s), frame_id
    message.muscle = list(MUSCLE_NAMES)
    message.commanded_voltage = list(status.commanded_v)
    message.measured_voltage = list(status.measured_v)
    message.current = list(status.current_a)
    message.mode = int(status.mode)
    message.fault_code = int(status.fault.code) if status.fault else 0
    message.grounded = status.ground is Ground.PROVEN
    message.ground = int(status.ground or Ground.NOT)
    message.interlock = _interlock(status.interlock_closed)
    message.emergency_stop_holders = list(holders)
    message.maximum_voltage = limits.maximum_voltage_v if limits else math.nan
    message.slew_rate = limits.slew_v_per_ms * 1e3 if limits else math.nan
    message.trip_current = limits.trip_current_a if limits else math.nan
    message.heartbeat_timeout = limits.heartbeat_s if limits else math.nan
    message.commander = commander
    if status.mode is Mode.FAULT:
        words = str(status.fault) if status.fault else "the supply is not connected, or does not report"
        message.fault_text = f"{sentence(words)} {OUTPUT_WORDS[status.output]}"
    elif status.note:
        message.fault_text = sentence(status.note)
    return message


def sentence(words: str) -> str:
    """With a capital and a full stop."""
    return f"{words[:1].upper()}{words[1:]}."


def _interlock(closed: tuple[bool, bool] | None) -> list[int]:
    if closed is None:
        return [SupplyState.INTERLOCK_UNKNOWN] * 2
    return [SupplyState.INTERLOCK_CLOSED if each else SupplyState.INTERLOCK_OPEN for each in closed]


def supply_health(status: SupplyStatus | None) -> tuple[Level, str, dict[str, object]]:
    """What `/diagnostics` says of a supply: level, sentence, values; no status means that none is configured."""
    if status is None:
        return Level.WARN, "not configured: the port is closed", {}
    level = Level.WARN if status.silent_s else Level.OK
    level = Level.ERROR if status.mode is Mode.FAULT else level
    words = str(status) + (f", no report for {status.silent_s:.1f} s" if status.silent_s else "")
    return level, words, {"mode": status.mode.name, "output": status.output}
