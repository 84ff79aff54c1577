# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What can go wrong: errors that tell a caller, faults that ground the output, and those a restarted node has still."""

import json
from dataclasses import asdict, dataclass, replace
from enum import IntEnum
from pathlib import Path
from typing import Any

LATCHED_FILE = "latched_faults.json"


class DriverError(Exception):
    """Base class of the driver's errors."""


class ProtocolError(DriverError):
    """A line that the serial protocol does not allow."""


class LimitError(DriverError):
    """A value outside its range, or not a number."""


class PortError(DriverError):
    """A serial port that cannot be opened, or a device on it that is not the expected one."""


class PortMissingError(PortError):
    """A serial port that is not there, or not yet."""


class PortInUseError(PortError):
    """A serial port that another program has open."""


class RefusedError(DriverError):
    """A request that the present state does not allow."""


class FaultCode(IntEnum):
    """`fault_code` of `/hasel/state`, each with its `explanation`; the board's are those of `firmware/PROTOCOL.md`."""

    explanation: str

    def __new__(cls, code: int, explanation: str = "") -> "FaultCode":
        member = int.__new__(cls, code)
        member._value_, member.explanation = code, explanation
        return member

    NONE = 0, "no fault"
    HEARTBEAT = 1, "the board heard no valid command within its heartbeat timeout"
    OVERCURRENT = 2, "the current exceeded the trip level, or its monitor's range"
    STOP = 3, "the board received a stop"
    INTERLOCK = 4, "the interlock is open"
    SEQUENCE = 5, "the board missed a command, or a second master speaks on the port"
    GARBAGE = 6, "the board received a garbled line"
    OVERVOLTAGE = 7, "the measured voltage exceeded the maximum, or its monitor's range"
    NOT_GROUNDED = 8, "the ground contact should be closed, but there is voltage, or its proof failed"
    MONITOR = 9, "the measured voltage does not follow the asked one, or is not measured at all"
    EEPROM = 10, "the calibration in the board's EEPROM is damaged: store one, or `calibrate --forget`"
    DISCREPANCY = 11, "the two channels of the interlock disagreed"
    EMERGENCY_STOP = 100, "emergency stop"
    LINK_LOST = 101, "the serial port is gone"
    NO_TELEMETRY = 102, "the board's telemetry ceased"
    NO_REPLY = 103, "the board did not answer a command"
    DEVICE_RESET = 104, "the board was reset"
    GARBAGE_RECEIVED = 105, "a garbled line came from the board"
    COMMAND_REFUSED = 106, "the board refused a command"
    TWO_MASTERS = 107, "more than one source of commands"
    INVALID_COMMAND = 108, "a command was not a number for each muscle"
    HOST_STALLED = 109, "the driver node stopped responding"
    ILLEGAL_TRANSITION = 110, "an illegal lifecycle transition was requested while armed"
    UNEXPECTED_STATE = 111, "the board is in a state that nobody asked for"
    GROUND_NOT_PROVEN = 112, "the output should be grounded, and is not proven to be"
    ABOVE_MAXIMUM = 113, "the driver read more than the maximum voltage"
    STOP_NOT_HEARD = 114, "an emergency stop's publisher cannot be heard"
    TWO_DRIVERS = 115, "another driver answers to the same names"


@dataclass(frozen=True)
class Fault:
    """A latched fault; prints as a sentence. `stop`: the emergency stop that came besides, in words."""

    code: FaultCode
    detail: str = ""
    stop: str = ""

    def __str__(self) -> str:
        words = self.code.explanation
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


class FaultStore:
    """One file in `folder`, an entry for each port; an empty folder keeps nothing."""

    def __init__(self, folder: str, port: str) -> None:
        self._path = Path(folder).expanduser() / LATCHED_FILE if folder else None
        self._port = port
        self._kept: Fault | None = None

    def load(self) -> Fault | None:
        """The fault that was kept. Raises PortError where the file makes no sense: nobody knows then."""
        entry = self._entries().get(self._port)
        try:
            self._kept = Fault(**{**entry, "code": FaultCode(entry["code"])}) if entry else None
        except (KeyError, TypeError, ValueError) as error:
            raise self._unreadable() from error
        return self._kept

    def keep(self, fault: Fault | None) -> None:
        """From now on this fault, or none; written where that is a change. Raises OSError."""
        outlives = fault if fault is not None and fault.code in OUTLIVE_RESTART else None
        if self._path is None or outlives == self._kept:
            return
        self._kept = outlives
        entries = self._entries()
        entries.pop(self._port, None)
        if outlives is not None:
            entries[self._port] = asdict(outlives)
        self._path.parent.mkdir(parents=True, exist_ok=True)
        beside = self._path.with_suffix(".new")
        beside.write_text(json.dumps(entries, indent=1))
        beside.replace(self._path)

    def _entries(self) -> dict[str, Any]:
        if self._path is None or not self._path.is_file():
            return {}
        try:
            entries = json.loads(self._path.read_text())
        except ValueError as error:
            raise self._unreadable() from error
        if not isinstance(entries, dict):
            raise self._unreadable()
        return entries

    def _unreadable(self) -> PortError:
        return PortError(
            f"{self._path} cannot be read, so it is not known whether a fault was left:"
            " see to the supply, then remove it."
        )
