# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Two SHVPS boards, one for each muscle, as one supply.

Unlike the supply of `firmware/`, an SHVPS goes on when its host dies, has no latched trip, reports no ground
contact and gives one polarity only. Its STANDBY therefore means: it answered that it is switched off.
"""

import math
import re
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress

from hasel_driver.protocol.faults import FaultCode, PortError, SupplyFaultError
from hasel_driver.protocol.limits import Limits, Voltages
from hasel_driver.protocol.status import Mode
from hasel_driver.protocol.wire import LineBuffer
from hasel_driver.supplies.serial_port import SerialPort
from hasel_driver.supplies.supply import Capabilities, Connection, Reading, Supply

REPLY_TIMEOUT_S = 0.2
POLLED = ("QVnow", "QVset", "QSwMode")
OFF, DIRECT_CURRENT = 0, 1  # values of SSwMode


class ShvpsChannel:
    """One SHVPS board (Peta-pico-Voltron, HardwareX 2018): one command at a time, each answered by one value.

    Keeps `values` (by POLLED's names) up to date; commands wait for the answer of the one before.
    """

    def __init__(self, port: SerialPort) -> None:
        self.port = port
        self._forget()

    def _forget(self) -> None:
        self._lines = LineBuffer()
        self._waiting: deque[str] = deque()
        self._asked: str | None = None
        self._deadline_s = 0.0
        self._next_poll = 0
        self._polled_last = True
        self.values: dict[str, float] = {}
        self.round = 0  # how often all of POLLED have been answered

    def open(self) -> None:
        """Open the port; what the board said before is forgotten."""
        self._forget()
        self.port.open()

    def send(self, *commands: str) -> None:
        """Queue commands; a set-point still waiting is replaced by a newer one."""
        for command in commands:
            if command.startswith("SVset"):
                self._waiting = deque(c for c in self._waiting if not c.startswith("SVset"))
            self._waiting.append(command)

    def send_at_once(self, *commands: str) -> None:
        """Forget what waits and write now, without waiting for the answer that is due."""
        self._waiting.clear()
        for command in commands:
            self.port.write(command.encode() + b"\r")
        self._asked = None
        self._lines.clear()

    def service(self, now_s: float) -> None:
        """Take answers, and ask on."""
        for line in self._lines.feed(self.port.read()):
            self._take(line.decode("ascii", errors="replace").strip())
        if self._asked is not None:
            if now_s > self._deadline_s:
                asked, self._asked = self._asked, None
                raise SupplyFaultError(FaultCode.NO_REPLY, f"{asked} on {self.port.path}")
            return
        if self._waiting and self._polled_last:
            self._ask(self._waiting.popleft(), now_s)
        else:
            self._ask(POLLED[self._next_poll], now_s)
            self._next_poll = (self._next_poll + 1) % len(POLLED)
        # Take turns: a stream of commands must not starve the polls.
        self._polled_last = self._asked in POLLED

    def _ask(self, command: str, now_s: float) -> None:
        self.port.write(command.encode() + b"\r")
        self._asked, self._deadline_s = command, now_s + REPLY_TIMEOUT_S

    def _take(self, answer: str) -> None:
        asked, self._asked = self._asked, None
        if asked is None:
            return  # the answer to a command that was overtaken by a stop
        if answer.startswith("Err"):
            raise SupplyFaultError(FaultCode.COMMAND_REFUSED, f"{asked} on {self.port.path}")
        number = re.fullmatch(r"-?\d+(\.\d+)?", answer)
        if number is None:
            raise SupplyFaultError(FaultCode.GARBAGE_RECEIVED, f"{answer!r} in answer to {asked}")
        if asked in POLLED:
            self.values[asked] = float(answer)
            self.round += asked == POLLED[-1]

    def identify(self, clock: Callable[[], float]) -> str:
        """Ask for the board's version, waiting. Raises PortError where no SHVPS answers."""
        for _ in range(3):  # the boot loader may swallow the first question
            self.port.write(b"QVer\r")
            deadline_s = clock() + 1.0
            while clock() < deadline_s:
                for line in self._lines.feed(self.port.read()):
                    if b"slave" in line:
                        return line.decode("ascii", errors="replace").strip()
                time.sleep(0.005)
        raise PortError(
            f"No SHVPS answered QVer on {self.port.path}: check the port, and that the board is powered."
        )


class ShvpsSupply(Supply):
    """Upper muscle on the first port, lower muscle on the second."""

    capabilities = Capabilities(deadman=False, proves_grounded=False, bipolar=False, waveforms=False)

    def __init__(
        self,
        ports: tuple[SerialPort, SerialPort],
        limits: Limits,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(limits)
        self._channels = tuple(ShvpsChannel(port) for port in ports)
        self._clock = clock
        self._rounds = (0, 0)

    def open(self, prove: bool = False) -> Connection:
        self._rounds = (0, 0)
        names = []
        try:
            for channel in self._channels:
                channel.open()
                names.append(channel.identify(self._clock))
                channel.send("SVset 0", f"SSwMode {OFF}")
        except (PortError, SupplyFaultError) as error:
            self.close()
            if isinstance(error, PortError):
                raise
            raise PortError(str(error)) from error
        return Connection("SHVPS " + ", ".join(names))

    def close(self) -> None:
        for channel in self._channels:
            if channel.port.fileno() is not None:
                with suppress(SupplyFaultError):
                    channel.send_at_once("SVset 0", f"SSwMode {OFF}")
            channel.port.close()

    def descriptors(self) -> list[int]:
        descriptors = [channel.port.fileno() for channel in self._channels]
        return [descriptor for descriptor in descriptors if descriptor is not None]

    def service(self, now_s: float, heartbeat: bool) -> list[Reading]:
        for channel in self._channels:
            channel.service(now_s)
        upper, lower = (channel.round for channel in self._channels)
        rounds = (upper, lower)
        if any(new <= old for new, old in zip(rounds, self._rounds, strict=True)):
            return []
        self._rounds = rounds
        return [self._reading(now_s)]

    def arm(self) -> None:
        for channel in self._channels:
            channel.send("SVset 0", f"SSwMode {DIRECT_CURRENT}")

    def disarm(self) -> None:
        for channel in self._channels:
            channel.send_at_once("SVset 0", f"SSwMode {OFF}")

    def stop(self) -> None:
        self.disarm()

    def set_voltage(self, voltage_v: Voltages) -> None:
        for channel, value in zip(self._channels, voltage_v, strict=True):
            channel.send(f"SVset {round(value)}")

    def _reading(self, now_s: float) -> Reading:
        values = [channel.values for channel in self._channels]
        commanded = (values[0]["QVset"], values[1]["QVset"])
        switched_on = any(value["QSwMode"] != OFF for value in values)
        mode = Mode.STANDBY if not switched_on else Mode.ACTIVE if any(commanded) else Mode.ARMED
        return Reading(
            time_s=now_s,
            mode=mode,
            ground=None,
            fault=None,
            commanded_v=commanded,
            measured_v=(values[0]["QVnow"], values[1]["QVnow"]),
            current_a=(math.nan, math.nan),
        )
