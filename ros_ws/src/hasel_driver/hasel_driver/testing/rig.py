# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A supply in a process of its own that tells the truth about its output, and the driver's thread on it."""

import os
import queue
import subprocess
import sys
import threading
import time
import tty
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

from hasel_driver.protocol import wire
from hasel_driver.protocol.faults import DriverError
from hasel_driver.protocol.limits import Limits, Voltages
from hasel_driver.protocol.status import Ground, Mode, SupplyStatus
from hasel_driver.safety.supervisor import Supervisor
from hasel_driver.safety.supply_thread import SupplyThread, request_realtime
from hasel_driver.supplies.hasel_supply import HaselSupply
from hasel_driver.supplies.serial_port import SerialPort

PERIOD_S = 0.01
TOLERANCE_S = 0.05
PRIORITY = 50
VIRTUAL_SUPPLY = [sys.executable, "-m", "hasel_driver.virtual.virtual_supply"]


class Punctuality:
    """Whether this machine kept time: a test against the clock proves nothing on one that did not.

    Measures in the background how late a thread is woken, and a byte is passed on by a pseudo-terminal.
    The latter needs a worker of the kernel, which on a busy virtual machine can be a second late where threads are
    not. Others may add what they were late.
    """

    def __init__(self) -> None:
        self._late: list[tuple[float, float]] = []  # (when, how late) [s]
        for wait in (lambda: time.sleep(PERIOD_S), _pass_on_a_byte()):
            threading.Thread(target=self._watch, args=(wait,), daemon=True).start()

    def _watch(self, wait: Callable[[], None]) -> None:
        while True:
            asleep_s = time.monotonic()
            wait()
            awake_s = time.monotonic()
            if awake_s - asleep_s > PERIOD_S + TOLERANCE_S:
                self.note(awake_s - asleep_s - PERIOD_S)

    def note(self, late_s: float) -> None:
        """Something was late just now, by `late_s` [s]."""
        self._late.append((time.monotonic(), late_s))

    def worst_since(self, begin_s: float) -> float:
        """Longest delay beyond the tolerance since `begin_s` (monotonic) [s]; 0 if there was none."""
        return max((late_s for when_s, late_s in self._late if when_s >= begin_s), default=0.0)


def _pass_on_a_byte() -> Callable[[], None]:
    here, there = os.openpty()
    tty.setraw(there)

    def wait() -> None:
        time.sleep(PERIOD_S)
        os.write(here, b".")
        os.read(there, 1)

    return wait


def firmware_command(build: Path) -> list[str]:
    """The firmware in its simulator, as of the folder of a build."""
    return [str(build / "simulate"), str(build / "hasel_supply.elf")]


def _pipes(process: subprocess.Popen[str]) -> tuple[IO[str], IO[str]]:
    """Standard input and output of a process that was started with a pipe for each."""
    if process.stdin is None or process.stdout is None:
        raise DriverError("The supply's process was started without pipes: give it one for input and output.")
    return process.stdin, process.stdout


class Rig:
    """Starts `command`, which speaks as `virtual_supply` does on its standard input and output.

    `on_late` is told by how much the supply fell behind real time [s].
    """

    def __init__(self, command: list[str], on_late: Callable[[float], None] = lambda _: None) -> None:
        self._on_late = on_late
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
        )
        self._input, self._output = _pipes(self._process)
        self._answers: queue.Queue[list[str]] = queue.Queue()
        self._ports: queue.Queue[str] = queue.Queue()
        self.wire: list[tuple[float, int, int]] = []  # (monotonic time [s], voltages [V]) after `trace`
        self.changes: list[tuple[float, bool]] = []  # (monotonic time [s], live)
        threading.Thread(target=self._listen, daemon=True).start()
        self.port = self._ports.get(timeout=10)

    @property
    def process_id(self) -> int:
        """Of the supply's process."""
        return self._process.pid

    def keep_time(self) -> str | None:
        """From here on let no other process hold it up, as none holds up a board of its own; why not, or None."""
        threads = [int(task.name) for task in Path(f"/proc/{self.process_id}/task").iterdir()]
        return next(filter(None, [request_realtime(PRIORITY, thread) for thread in threads]), None)

    def _listen(self) -> None:
        for line in self._output:
            words = line.split()
            if words[:1] in (["live"], ["dead"]):
                self.changes.append((float(words[1]), words[0] == "live"))
            elif words[:1] == ["wire"]:
                self.wire.append((float(words[1]), int(words[2]), int(words[3])))
            elif words[:1] == ["late"]:
                self._on_late(float(words[1]))
            elif words[:1] == ["port"]:
                self._ports.put(words[1])
            elif words[:1] in (["output"], ["contacts"]):
                self._answers.put(words[1:])

    def say(self, word: str) -> None:
        """Inject a fault."""
        self._input.write(word + "\n")

    def replug(self) -> None:
        """Put the cable back; `port` changes."""
        self.say("replug")
        self.port = self._ports.get(timeout=5)

    def ask(self, word: str) -> list[float]:
        """The numbers of an answer."""
        self.say(word)
        return [float(number) for number in self._answers.get(timeout=5)]

    @property
    def live(self) -> bool:
        """Whether there is voltage, or an open ground contact, in truth."""
        return bool(self.changes) and self.changes[-1][1]

    def await_live(self, live: bool, timeout_s: float = 3.0) -> float:
        """Wait until the output is live, or dead; returns when it became so (monotonic) [s]."""
        deadline_s = time.monotonic() + timeout_s
        while time.monotonic() < deadline_s:
            if self.live == live:
                return self.changes[-1][0] if self.changes else 0.0
            time.sleep(0.002)
        raise AssertionError(f"the output did not become {'live' if live else 'dead'} in {timeout_s} s")

    def refutes_dead_at(self, time_s: float, margin_s: float = 0.05) -> bool:
        """Whether the output was live from `margin_s` before to `margin_s` after `time_s` (monotonic) [s]."""
        begin_s, end_s = time_s - margin_s, time_s + margin_s
        before = [live for change_s, live in self.changes if change_s <= begin_s]
        within = [live for change_s, live in self.changes if begin_s < change_s <= end_s]
        return bool(before) and before[-1] and all(within)

    def close(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.wait()


class Bench:
    """Connected on construction; `statuses` collects everything that the driver says."""

    def __init__(self, rig: Rig, limits: Limits | None = None) -> None:
        self.rig = rig
        self.statuses: list[SupplyStatus] = []
        self.host_alive = True
        self.port = SerialPort(rig.port, wire.BAUD)
        supply = HaselSupply(self.port, limits or Limits())
        self.supervisor = Supervisor(supply, time.monotonic)
        self.supervisor.connect()
        self.thread = SupplyThread(self.supervisor, supply, self.statuses.append, self._step)
        self.thread.start()

    def _step(self) -> None:
        if self.host_alive:
            self.thread.host_is_alive("test")

    def call(self, method: Callable[..., Any], *arguments: Any) -> Any:
        """Call a method of the supervisor in its thread."""
        return self.thread.call(lambda: method(*arguments)).result(timeout=10)

    def status(self) -> SupplyStatus:
        """The present status."""
        return self.call(self.supervisor.status)

    def await_mode(self, mode: Mode, timeout_s: float = 2.0) -> None:
        """Until the supply reports this mode."""
        if not self.thread.expect(lambda: self.supervisor.status().mode is mode, timeout_s).result(
            timeout=timeout_s + 5
        ):
            raise AssertionError(f"{mode.name} was expected, the state is {self.status()}")

    def arm(self) -> None:
        """Arm, and wait for the proof."""
        self.await_mode(Mode.STANDBY)
        self.call(self.supervisor.arm)
        self.await_mode(Mode.ARMED)
        self.call(self.supervisor.command, (0.0, 0.0))  # with which every controller begins

    def command_until(
        self, condition: Callable[[], bool], voltage_v: Voltages = (3000.0, -2000.0), timeout_s: float = 2.0
    ) -> bool:
        """Command `voltage_v` at 100 Hz until `condition()`; whether it came true."""
        end_s = time.monotonic() + timeout_s
        while not condition():
            if time.monotonic() > end_s:
                return False
            self.call(self.supervisor.command, voltage_v)
            time.sleep(0.01)
        return True

    def wait_until(self, condition: Callable[[], bool], timeout_s: float = 2.0) -> bool:
        """Wait without a command until `condition()`; whether it came true."""
        end_s = time.monotonic() + timeout_s
        while not condition():
            if time.monotonic() > end_s:
                return False
            time.sleep(0.002)
        return True

    def false_claims(self) -> list[str]:
        """Statuses that called the output grounded, or claimed STANDBY or ARMED, while it was live in truth."""
        return [
            str(status)
            for status in list(self.statuses)
            if (status.ground is Ground.PROVEN or status.mode in (Mode.STANDBY, Mode.ARMED))
            and self.rig.refutes_dead_at(status.time_s)
        ]

    def close(self) -> None:
        """End the thread."""
        self.thread.stop()
