"""Codes and plain words of every latched fault: below 100 the board's own, from 100 on the driver's."""

from dataclasses import dataclass, replace
from enum import IntEnum


class FaultCode(IntEnum):
    """`fault_code` of `/hasel/state`; the board's codes are those of `firmware/PROTOCOL.md`."""

    NONE = 0
    HEARTBEAT = 1
    OVERCURRENT = 2
    STOP = 3
    INTERLOCK = 4
    SEQUENCE = 5
    GARBAGE = 6
    OVERVOLTAGE = 7
    NOT_GROUNDED = 8
    MONITOR = 9
    EEPROM = 10
    DISCREPANCY = 11
    EMERGENCY_STOP = 100
    LINK_LOST = 101
    NO_TELEMETRY = 102
    NO_REPLY = 103
    DEVICE_RESET = 104
    GARBAGE_RECEIVED = 105
    COMMAND_REFUSED = 106
    TWO_MASTERS = 107
    INVALID_COMMAND = 108
    HOST_STALLED = 109
    ILLEGAL_TRANSITION = 110
    UNEXPECTED_STATE = 111
    GROUND_NOT_PROVEN = 112
    ABOVE_MAXIMUM = 113
    STOP_NOT_HEARD = 114
    TWO_DRIVERS = 115


EXPLANATIONS: dict[FaultCode, str] = {
    FaultCode.NONE: "no fault",
    FaultCode.HEARTBEAT: "the board heard no valid command within its heartbeat timeout",
    FaultCode.OVERCURRENT: "the current exceeded the trip level, or its monitor's range",
    FaultCode.STOP: "the board received a stop",
    FaultCode.INTERLOCK: "the interlock is open",
    FaultCode.SEQUENCE: "the board missed a command, or a second master speaks on the port",
    FaultCode.GARBAGE: "the board received a garbled line",
    FaultCode.OVERVOLTAGE: "the measured voltage exceeded the maximum, or its monitor's range",
    FaultCode.NOT_GROUNDED: "the ground contact should be closed, but there is voltage, or its proof failed",
    FaultCode.MONITOR: "the measured voltage does not follow the asked one, or is not measured at all",
    FaultCode.EEPROM: "the calibration in the board's EEPROM is damaged: store one, or `calibrate --forget`",
    FaultCode.DISCREPANCY: "the two channels of the interlock disagreed",
    FaultCode.EMERGENCY_STOP: "emergency stop",
    FaultCode.LINK_LOST: "the serial port is gone",
    FaultCode.NO_TELEMETRY: "the board's telemetry ceased",
    FaultCode.NO_REPLY: "the board did not answer a command",
    FaultCode.DEVICE_RESET: "the board was reset",
    FaultCode.GARBAGE_RECEIVED: "a garbled line came from the board",
    FaultCode.COMMAND_REFUSED: "the board refused a command",
    FaultCode.TWO_MASTERS: "more than one source of commands",
    FaultCode.INVALID_COMMAND: "a command was not a number for each muscle",
    FaultCode.HOST_STALLED: "the driver node stopped responding",
    FaultCode.ILLEGAL_TRANSITION: "an illegal lifecycle transition was requested while armed",
    FaultCode.UNEXPECTED_STATE: "the board is in a state that nobody asked for",
    FaultCode.GROUND_NOT_PROVEN: "the output should be grounded, and is not proven to be",
    FaultCode.ABOVE_MAXIMUM: "the driver read more than the maximum voltage",
    FaultCode.STOP_NOT_HEARD: "an emergency stop's publisher cannot be heard",
    FaultCode.TWO_DRIVERS: "another driver answers to the same names",
}


@dataclass(frozen=True)
class Fault:
    """A latched fault; prints as a sentence. `stop`: the emergency stop that came besides, in words."""

    code: FaultCode
    detail: str = ""
    stop: str = ""

    def __str__(self) -> str:
        words = EXPLANATIONS[self.code]
        words = f"{words}: {self.detail}" if self.detail else words
        return f"{words}; besides, {self.stop}" if self.stop else words

    def beside(self, other: "Fault") -> "Fault":
        """This fault, which also shows the emergency stop that `other` is, or shows."""
        return replace(self, stop=str(other) if other.code is FaultCode.EMERGENCY_STOP else other.stop)


# Only a proof of the ground contacts, or of the monitors, takes these away.
NEED_PROOF = {FaultCode.NOT_GROUNDED, FaultCode.GROUND_NOT_PROVEN, FaultCode.MONITOR}
# These a restarted node has still.
OUTLIVE_RESTART = NEED_PROOF | {FaultCode.EMERGENCY_STOP, FaultCode.DISCREPANCY}

# While nothing is armed, by the board's last word too, these are no fault: the state is unknown, and arming refused.
BORNE_AT_REST = {FaultCode.NO_TELEMETRY, FaultCode.GARBAGE_RECEIVED}


class SupplyFaultError(Exception):
    """Raised where a fault is found; whoever catches it grounds the output and latches `fault`."""

    def __init__(self, code: FaultCode, detail: str = "") -> None:
        self.fault = Fault(code, detail)
        super().__init__(str(self.fault))
