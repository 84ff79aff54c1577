# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The node's end of the safety process: asks it, and knows what it told last."""

import contextlib
import itertools
import os
import socket
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from typing import Any

from hasel_driver.protocol.faults import PortError, RefusedError
from hasel_driver.protocol.limits import Limits
from hasel_driver.protocol.status import UNKNOWN, Mode, SupplyStatus
from hasel_driver.safety.driven_experiment import ExperimentProgress
from hasel_driver.supplies.supply import Capabilities

ANSWER_S = 10.0  # with a board that is connected anew
START_S = 30.0  # for a new interpreter on a busy machine, and the board's proof
SILENT_S = 0.4  # after which what the process told last is no longer what is
END_S = 5.0
MOST_WAIT_S = 1  # for a process that takes nothing in, although some thousand requests lie before it
ENDED = "The safety process has ended, so the board grounds itself: clean up and configure the node."


@dataclass(frozen=True)
class Snapshot:
    """All that the node knows of the supply; `refusal`: why it did not arm, in its own words."""

    status: SupplyStatus
    armed: bool
    connected: bool
    name: str | None
    limits: Limits
    capabilities: Capabilities
    refusal: str | None
    rejected_commands: int
    garbled_lines: int
    experiment: ExperimentProgress | None
    without_realtime: str | None  # why


@dataclass(frozen=True)
class Request:
    """A method of SafetyProcess and its arguments; a `number` of None wants no answer."""

    number: int | None
    method: str
    arguments: tuple[Any, ...] = ()


@dataclass(frozen=True)
class Answer:
    """What became of a request, and the supply after it."""

    number: int
    result: Any
    error: Exception | None
    snapshot: Snapshot


class SupplyLink:
    """Starts the process, which opens the supply; `on_snapshot` is called in a thread of its own, in their order.

    Raises:
        DriverError: what kept the process from opening the supply.
    """

    def __init__(self, parameters: Mapping[str, Any], on_snapshot: Callable[[Snapshot], None]) -> None:
        self._on_snapshot = on_snapshot
        self._answers: dict[int, Future[Answer]] = {}
        self._numbers = itertools.count(1)
        self._sending, self._news = threading.Lock(), threading.Condition()
        self._ended = False
        ours, theirs = socket.socketpair()
        with theirs:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "hasel_driver.safety.safety_process", str(theirs.fileno())],
                pass_fds=[theirs.fileno()],
                stdin=subprocess.DEVNULL,
                start_new_session=True,  # Ctrl-C is the node's, which says how both are to end
                env={**os.environ, "PYTHONSAFEPATH": "1"},  # a file signal.py beside the data is not Python's
            )
        ours.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, struct.pack("ll", MOST_WAIT_S, 0))
        self._socket, self._connection = ours, Connection(os.dup(ours.fileno()))
        self._latest, self._heard_s = self._begin(parameters), time.monotonic()
        threading.Thread(target=self._read, name="supply", daemon=True).start()

    @property
    def process_id(self) -> int:
        """Of the safety process."""
        return self._process.pid

    @property
    def now(self) -> Snapshot:
        """What is known of the supply now; of a process that ended or fell silent its state is not."""
        latest, now_s = self._latest, time.monotonic()
        if not self._ended and now_s - self._heard_s < SILENT_S:
            return latest
        lost = SupplyStatus(now_s, Mode.FAULT, latest.status.fault, None, UNKNOWN, UNKNOWN, UNKNOWN)
        return replace(latest, status=lost, armed=latest.armed and not self._ended)

    def is_alive(self) -> bool:
        """Whether the process still serves the supply."""
        return not self._ended

    def ask(self, method: str, *arguments: Any, timeout_s: float = ANSWER_S) -> Any:
        """The result of a method of SafetyProcess, or its exception; `now` is what follows from it.

        Raises:
            RefusedError: there is no answer.
        """
        number = next(self._numbers)
        future: Future[Any] = Future()
        self._answers[number] = future
        if not self._send(Request(number, method, arguments)):
            self._refuse_all()
        try:
            return future.result(timeout_s)
        except TimeoutError as error:
            raise RefusedError(
                f"The safety process did not answer within {timeout_s:g} s: treat the output as live."
            ) from error

    def tell(self, method: str, *arguments: Any) -> None:
        """Have a method of SafetyProcess run, as soon as it can."""
        self._send(Request(None, method, arguments))

    def wait_for(self, condition: Callable[[Snapshot], bool], timeout_s: float) -> bool:
        """Wait until `condition` holds of what is known; whether it came to that."""
        with self._news:
            return self._news.wait_for(lambda: self._ended or condition(self.now), timeout_s) and condition(
                self.now
            )

    def stop(self) -> None:
        """Disarm, have that proven or a fault, close the port, and end the process."""
        with contextlib.suppress(RefusedError):
            self.ask("come_to_rest", timeout_s=END_S)
        with contextlib.suppress(OSError):
            self._socket.shutdown(socket.SHUT_WR)
        self._end()

    def _end(self) -> None:
        try:
            self._process.wait(END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()  # without its heartbeat the board grounds itself
            self._process.wait()

    def _begin(self, parameters: Mapping[str, Any]) -> Snapshot:
        """The first snapshot; raises what kept the process from it."""
        first: Any = None
        with contextlib.suppress(EOFError, OSError):
            self._connection.send(dict(parameters))
            first = self._connection.recv() if self._connection.poll(START_S) else None
        if isinstance(first, Snapshot):
            return first
        self._close()
        self._end()
        raise first or PortError(
            "The process that talks to the supply ended before it had opened the port: its words are above."
        )

    def _send(self, request: Request) -> bool:
        with self._sending:
            if self._ended:
                return False
            try:
                self._connection.send(request)
            except BlockingIOError:  # it takes nothing in: without it the board grounds itself
                self._process.kill()
                return False
            except OSError:  # it has ended, which the reader notices too
                return False
        return True

    def _read(self) -> None:
        try:
            while (message := self._receive()) is not None:
                self._take(message)
        finally:  # also where a snapshot could not be taken: what nobody hears of is not driven
            with self._sending, self._news:
                self._ended = True
                self._news.notify_all()
            self._refuse_all()
            self._close()

    def _receive(self) -> Snapshot | Answer | None:
        try:
            return self._connection.recv()
        except (EOFError, OSError):
            return None

    def _close(self) -> None:
        self._connection.close()
        self._socket.close()

    def _take(self, message: Snapshot | Answer) -> None:
        snapshot = message.snapshot if isinstance(message, Answer) else message
        with self._news:
            self._latest, self._heard_s = snapshot, time.monotonic()
            self._news.notify_all()
        if isinstance(message, Snapshot):
            self._on_snapshot(snapshot)
            return
        waiting = self._answers.pop(message.number, None)
        if waiting is None:
            return  # it has been refused meanwhile
        if message.error is not None:
            waiting.set_exception(message.error)
        else:
            waiting.set_result(message.result)

    def _refuse_all(self) -> None:
        while self._answers:
            with contextlib.suppress(KeyError):
                self._answers.popitem()[1].set_exception(RefusedError(ENDED))
