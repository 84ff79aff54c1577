"""One SHVPS board (Peta-pico-Voltron, HardwareX 2018): one command at a time, each answered by one value."""

import re
from collections import deque

from hasel_driver.errors import PortError
from hasel_driver.faults import FaultCode, SupplyFaultError
from hasel_driver.line_buffer import LineBuffer
from hasel_driver.serial_port import SerialPort

REPLY_TIMEOUT_S = 0.2
POLLED = ("QVnow", "QVset", "QSwMode")
OFF, DIRECT_CURRENT = 0, 1  # values of SSwMode


class ShvpsChannel:
    """Keeps `values` (by POLLED's names) up to date; commands wait for the answer of the one before."""

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
        self._polled_last = (
            self._asked in POLLED
        )  # take turns: a stream of commands must not starve the polls

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

    def identify(self, clock, sleep) -> str:
        """Ask for the board's version, waiting. Raises PortError where no SHVPS answers."""
        for _ in range(3):  # the boot loader may swallow the first question
            self.port.write(b"QVer\r")
            deadline_s = clock() + 1.0
            while clock() < deadline_s:
                for line in self._lines.feed(self.port.read()):
                    if b"slave" in line:
                        return line.decode("ascii", errors="replace").strip()
                sleep(0.005)
        raise PortError(
            f"No SHVPS answered QVer on {self.port.path}: check the port, and that the board is powered."
        )
