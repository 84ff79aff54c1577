"""Makes the supply that the parameters name."""

from collections.abc import Mapping
from typing import Any

from hasel_driver import protocol
from hasel_driver.errors import LimitError
from hasel_driver.hasel_supply import HaselSupply
from hasel_driver.limits import Limits
from hasel_driver.serial_port import SerialPort
from hasel_driver.shvps_supply import ShvpsSupply
from hasel_driver.supply import Supply


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


def make_supply(parameters: Mapping[str, Any]) -> Supply:
    """A supply, not yet opened. Raises LimitError where a parameter makes no sense."""
    limits = limits_of(parameters)
    if parameters["backend"] == "hasel":
        return HaselSupply(SerialPort(parameters["port"], protocol.BAUD), limits)
    if not parameters["second_port"]:
        raise LimitError(
            "The backend shvps drives one board for each muscle: set `second_port` to the lower one's."
        )
    return ShvpsSupply((SerialPort(parameters["port"]), SerialPort(parameters["second_port"])), limits)
