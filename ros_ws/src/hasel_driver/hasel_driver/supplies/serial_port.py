# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A serial port opened for one host alone, read and written without waiting."""

import contextlib
import fcntl
import os
import select

import serial

from hasel_driver.protocol.faults import FaultCode, PortInUseError, PortMissingError, SupplyFaultError


def check_not_in_use(path: str) -> None:
    """Raises PortInUseError where another program has locked the port; what else is wrong shows when it is opened."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOCTTY | os.O_NONBLOCK)
    except OSError:
        return
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        raise _in_use(path) from error
    finally:
        os.close(descriptor)


def _in_use(path: str) -> PortInUseError:
    return PortInUseError(
        f"The serial port {path} cannot be opened: another program has it open; end that first. This node ends, so that"
        " its services do not answer for the other's."
    )


class SerialPort:
    """Raw bytes to and from a device; a port that goes away raises SupplyFaultError(LINK_LOST)."""

    def __init__(self, path: str, baud: int = 115_200) -> None:
        self.path = path
        self._baud = baud
        self._serial: serial.Serial | None = None

    def open(self) -> None:
        """Open and lock the port.

        Raises:
            PortMissingError: there is no such port, or access is denied.
            PortInUseError: another program has it open.
        """
        try:
            self._serial = serial.Serial(self.path, self._baud, timeout=0, write_timeout=0, exclusive=True)
        except (OSError, ValueError) as error:
            if "lock" in str(error):
                raise _in_use(self.path) from error
            raise PortMissingError(
                f"The serial port {self.path} cannot be opened ({error}): check the cable, the parameter"
                " `port`, that the user is in the group dialout, and that no other program uses it."
            ) from error

    def close(self) -> None:
        """Close the port; a port that is already gone counts as closed."""
        if self._serial is not None:
            with contextlib.suppress(OSError):
                self._serial.close()
        self._serial = None

    def fileno(self) -> int | None:
        """File descriptor to wait on; None while closed."""
        return None if self._serial is None else self._serial.fileno()

    def read(self) -> bytes:
        """What has arrived; empty if nothing."""
        descriptor = self._descriptor()
        try:
            data = os.read(descriptor, 4096)
        except BlockingIOError:
            return b""
        except OSError as error:
            raise SupplyFaultError(FaultCode.LINK_LOST, f"{self.path}: {error.strerror}") from error
        if not data and _hung_up(descriptor):
            raise SupplyFaultError(FaultCode.LINK_LOST, f"{self.path} was hung up")
        return data

    def write(self, data: bytes) -> None:
        """Send all of `data` now; a full buffer means that nobody takes it."""
        descriptor = self._descriptor()
        try:
            sent = os.write(descriptor, data)
        except BlockingIOError:
            sent = 0
        except OSError as error:
            raise SupplyFaultError(FaultCode.LINK_LOST, f"{self.path}: {error.strerror}") from error
        if sent < len(data):
            raise SupplyFaultError(FaultCode.LINK_LOST, f"{self.path} takes no more data")

    def _descriptor(self) -> int:
        if self._serial is None:
            raise SupplyFaultError(FaultCode.LINK_LOST, f"{self.path} is not open")
        return self._serial.fileno()


def _hung_up(descriptor: int) -> bool:
    poll = select.poll()
    poll.register(descriptor, select.POLLIN)
    gone = select.POLLHUP | select.POLLERR | select.POLLNVAL
    return any(event & gone for _, event in poll.poll(0))
