# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The limits a supply is run within, and the clipping of commands to them."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from hasel_driver.protocol.faults import LimitError

HARDWARE_MAXIMUM_V = 9_800.0  # the monitors end at 10 kV: above this they could not tell too much from enough
DISCHARGED_V = 200.0  # below it a muscle counts as discharged
PULSE_V = 500.0  # of the test that proves the ground contacts, or the maximum where that is less
LEAST_PULSE_V = 100.0  # below it the monitors tell too little
GROUND_OHM = 2e6  # of the path that discharges a muscle
TOUCHABLE_V = 50.0
GROUNDED_WITHIN_S = 0.5  # of the host's death, whatever the load
WIRE_S = 0.02  # of that, for the host's last word on its way and the board's own clock

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
    contacts_read: bool = False  # auxiliary contacts of the ground relays are wired
    load_f: float = 4.5e-9  # of the largest muscle with its cable

    @property
    def silence_to_ground_s(self) -> float:
        """Time from the host's last word to less than 50 V on the largest muscle [s]."""
        fall = math.log(max(1.0, self.maximum_voltage_v / TOUCHABLE_V))
        return WIRE_S + self.heartbeat_s + self.dead_time_s + GROUND_OHM * self.load_f * fall

    def check_sum(self) -> None:
        """Raises LimitError where the limits, each allowed by itself, do not ground the output in time."""
        if self.silence_to_ground_s >= GROUNDED_WITHIN_S:
            raise LimitError(
                f"heartbeat_timeout {self.heartbeat_s:g} s, dead_time {self.dead_time_s:g} s, {WIRE_S:g} s on the wire"
                f" and the discharge of load_capacitance {self.load_f * 1e9:g} nF from {self.maximum_voltage_v:g} V"
                f" take {self.silence_to_ground_s:.3f} s in all, less than {GROUNDED_WITHIN_S:g} s was expected:"
                " lower heartbeat_timeout first."
            )


def limits_of(parameters: Mapping[str, Any]) -> Limits:
    """The limits that the parameters set. Raises LimitError where together they make no sense."""
    limits = Limits(
        maximum_voltage_v=parameters["maximum_voltage"],
        slew_v_per_ms=1e-3 * parameters["slew_rate"],
        trip_current_a=parameters["trip_current"],
        heartbeat_s=parameters["heartbeat_timeout"],
        dead_time_s=parameters["dead_time"],
        contacts_read=parameters["contacts_read_back"],
        load_f=parameters["load_capacitance"],
    )
    limits.check_sum()
    return limits


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
