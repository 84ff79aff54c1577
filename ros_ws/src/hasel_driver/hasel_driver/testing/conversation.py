# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A host that talks to a board line by line."""

import time
from collections.abc import Callable
from typing import Any

from hasel_driver.protocol import wire
from hasel_driver.protocol.status import Mode
from hasel_driver.protocol.wire import LineBuffer
from hasel_driver.supplies.serial_port import SerialPort


class Conversation:
    """Opens the port, waits for the board's banner, and sets MAXIMUM [V], which is 0 at boot."""

    def __init__(self, path: str, maximum_v: int | None = 6000) -> None:
        self._port = SerialPort(path, wire.BAUD)
        self._lines = LineBuffer()
        self._sequence = 255
        self.events: list[wire.Event] = []
        self.reports: list[wire.Telemetry] = []
        self._replies: list[wire.Reply] = []
        self._open()
        if maximum_v is not None:
            self.ask("SET", "MAXIMUM", maximum_v)
            self._sequence = 255

    def _open(self) -> None:
        """A banner that comes while pyserial still empties its buffers is lost: then once more."""
        for timeout_s in (1.0, 1.0, 3.0):
            self._port.open()
            try:
                self.until(lambda: any(event.words[0] == "BOOT" for event in self.events), timeout_s)
                return
            except AssertionError:
                self._port.close()
                time.sleep(0.05)
        raise AssertionError("the board's banner was not heard")

    def send(self, data: bytes) -> None:
        """Raw bytes."""
        self._port.write(data)

    def ask(self, *words: object, sequence: int | None = None) -> tuple[bool, str]:
        """Whether a command was accepted, and the words of the reply."""
        self._sequence = (self._sequence + 1) % 256 if sequence is None else sequence
        self.send(wire.encode_command(self._sequence, *words))
        return self.reply()

    def arm(self) -> None:
        """ARM, and its proof of ground."""
        if self.ask("ARM") != (True, "ARM"):
            raise AssertionError("the board did not arm")
        self.await_proof()

    def await_proof(self, timeout_s: float = 1.0) -> None:
        """Until the test pulse has ended; the heartbeat goes on."""
        end_s = time.monotonic() + timeout_s
        while self.listen(0.05)[-1].mode is Mode.ACTIVE:
            if time.monotonic() > end_s:
                raise AssertionError(f"the test pulse did not end within {timeout_s} s")

    def after(self, count: int) -> int:
        """The sequence number that is `count` after the last."""
        return (self._sequence + count) % wire.SEQUENCE_MODULUS

    def reply(self) -> tuple[bool, str]:
        """The next reply."""
        self.until(lambda: bool(self._replies))
        reply = self._replies.pop(0)
        return reply.accepted, " ".join(reply.words)

    def report(self) -> wire.Telemetry:
        """Telemetry of now."""
        self._take()
        time.sleep(0.03)
        self._take()
        self.reports.clear()
        self.until(lambda: bool(self.reports))
        return self.reports[-1]

    def listen(self, duration_s: float) -> list[wire.Telemetry]:
        """Telemetry of a while, during which the heartbeat goes on."""
        self.reports.clear()
        end_s = time.monotonic() + duration_s
        while time.monotonic() < end_s:
            self.ask("PING")
            time.sleep(0.02)
        return list(self.reports)

    def forget(self, duration_s: float) -> None:
        """Take whatever comes for a while, and drop it."""
        end_s = time.monotonic() + duration_s
        while time.monotonic() < end_s:
            self._take()
            time.sleep(0.01)
        self._replies.clear()

    def until(self, condition: Callable[[], bool], timeout_s: float = 3.0, cut_off: bool = False) -> None:
        """Read until `condition()` holds; cut_off: what a reset cut off may stand before BOOT in the same line."""
        end_s = time.monotonic() + timeout_s
        while not condition():
            if time.monotonic() > end_s:
                raise AssertionError(f"the board did not answer as expected within {timeout_s} s")
            self._take(cut_off)
            time.sleep(0.001)

    def await_boot(self) -> None:
        """Until the board says that it has started."""
        self.until(lambda: any(event.words[0] == "BOOT" for event in self.events), cut_off=True)

    def _take(self, cut_off: bool = False) -> None:
        kinds: dict[type, list[Any]] = {wire.Event: self.events, wire.Telemetry: self.reports}
        kinds[wire.Reply] = self._replies
        for line in self._lines.feed(self._port.read()):
            if cut_off and (begin := line.find(b"!BOOT")) > 0:
                line = line[begin:]
            message = wire.parse_device_line(line)
            kinds[type(message)].append(message)

    def close(self) -> None:
        """Close the port."""
        self._port.close()
