"""The limits a supply is run within, and the clipping of commands to them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from hasel_driver.errors import LimitError

HARDWARE_MAXIMUM_V = 9_800.0  # the monitors end at 10 kV: above this they could not tell too much from enough
MOST_TRIP_A = 980e-6  # of 1 mA, for the same reason
DISCHARGED_V = 200.0  # below it a muscle counts as discharged
LONGEST_HEARTBEAT_S = 2.0

MUSCLE_NAMES = ("upper", "lower")
Voltages = tuple[float, float]  # V, in the order of MUSCLE_NAMES


@dataclass(frozen=True)
class Limits:
    """Limits given to the board when the port is opened."""

    maximum_voltage_v: float = 6000.0
    slew_v_per_ms: float = 250.0
    trip_current_a: float = 450e-6
    heartbeat_s: float = 0.3
    dead_time_s: float = 0.005


def clip(requested: Sequence[float], maximum_v: float, bipolar: bool = True) -> Voltages:
    """`requested` [V] within ± `maximum_v`, or 0 to `maximum_v` for a supply of one polarity.

    Raises:
        LimitError: a value is NaN or infinite, or not one for each muscle; such a command must not be guessed at.
    """
    if len(requested) != len(MUSCLE_NAMES):
        raise LimitError(
            f"{len(requested)} voltages were commanded, expected {len(MUSCLE_NAMES)} ({', '.join(MUSCLE_NAMES)}): "
            "correct what sent them"
        )
    if not all(math.isfinite(value) for value in requested):
        raise LimitError(
            f"the voltages {requested} are not finite numbers: the controller that sent them is broken"
        )
    least = -maximum_v if bipolar else 0.0
    upper, lower = (min(max(value, least), maximum_v) for value in requested)
    return upper, lower
