# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What every high-voltage supply must do for the driver, whatever its protocol."""

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace

from hasel_driver.protocol.faults import Fault
from hasel_driver.protocol.limits import Limits, Voltages
from hasel_driver.protocol.status import Ground, Mode
from hasel_driver.protocol.waveform import Waveform


@dataclass(frozen=True)
class Capabilities:
    """What a kind of supply can do; the driver says plainly what it cannot."""

    deadman: bool  # grounds its output by itself when the host falls silent
    proves_grounded: bool  # reports its ground contacts
    bipolar: bool
    waveforms: bool  # generates them on the board


@dataclass(frozen=True)
class Connection:
    """What `open` found."""

    name: str  # of the device
    fault: Fault | None = None  # kept by the device from before


@dataclass(frozen=True)
class Reading:
    """A supply's report. Order upper, lower; [V], [A]; NaN where it does not know."""

    time_s: float  # host's monotonic clock, when it was measured
    mode: Mode
    ground: Ground | None  # None: it cannot tell
    fault: Fault | None
    commanded_v: Voltages
    measured_v: Voltages
    current_a: Voltages
    interlock_closed: tuple[bool, bool] | None = None  # by channel; None: it cannot tell


class Supply(ABC):
    """A supply of two channels. Used by one thread; nothing here waits but `open`.

    Requests return at once and are proven by later readings; a broken link or board raises SupplyFaultError.
    """

    capabilities: Capabilities

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self.refusal: str | None = None  # why the last `arm` was refused

    @abstractmethod
    def open(self, prove: bool = False) -> Connection:
        """Connect, disarm, set the limits, clear the board's fault; with `prove`, prove its ground where it can.

        Waits; raises PortError.
        """

    @abstractmethod
    def close(self) -> None:
        """Disarm if possible, and let go of the port."""

    @abstractmethod
    def descriptors(self) -> list[int]:
        """File descriptors that become readable when `service` has something to do."""

    @abstractmethod
    def service(self, now_s: float, heartbeat: bool) -> list[Reading]:
        """Take in what has arrived, send what is due; `heartbeat` False keeps silent."""

    @abstractmethod
    def arm(self) -> None:
        """Ask for ARMED."""

    @abstractmethod
    def disarm(self) -> None:
        """Ask for STANDBY."""

    @abstractmethod
    def stop(self) -> None:
        """Ask for a grounded output, latched where the board can."""

    @abstractmethod
    def set_voltage(self, voltage_v: Voltages) -> None:
        """Ask for a voltage within the limits; the newest replaces one not yet sent."""

    def ground(self) -> None:
        """Ask for 0 V at once, without waiting for the slew limit where the board can; still armed."""
        self.set_voltage((0.0, 0.0))

    def lower_maximum(self, voltage_v: float) -> None:
        """Ask for a lower limit [V], in any mode."""
        self.limits = replace(self.limits, maximum_voltage_v=voltage_v)

    def start(self, waveform: Waveform) -> None:
        """Run `waveform` on the board, where `capabilities.waveforms`."""
        raise NotImplementedError(
            f"{type(self).__name__} generates no waveforms; {waveform} must be streamed"
        )
