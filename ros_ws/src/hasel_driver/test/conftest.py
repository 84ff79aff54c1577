"""Supplies to test against: the virtual one, and the firmware in simavr; both with the same faults."""

import queue
import shutil
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from hasel_driver import protocol
from hasel_driver.hasel_supply import HaselSupply
from hasel_driver.limits import Limits
from hasel_driver.line_buffer import LineBuffer
from hasel_driver.serial_port import SerialPort
from hasel_driver.supervisor import Status, Supervisor
from hasel_driver.supply_thread import SupplyThread

FIRMWARE = Path(__file__).parents[1] / "firmware"
NEEDED_FILES = {
    "arduino-core-avr": "/usr/share/arduino/hardware/arduino/avr/cores/arduino/Arduino.h",
    "libsimavr-dev": "/usr/include/simavr/sim_avr.h",
}
NEEDED_PROGRAMS = {"gcc-avr": "avr-g++", "gcc": "cc", "make": "make"}


class Rig:
    """A supply in a process of its own, which tells the truth about its output."""

    def __init__(self, command: list[str]) -> None:
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
        )
        self._answers: queue.Queue[list[str]] = queue.Queue()
        self._ports: queue.Queue[str] = queue.Queue()
        self.changes: list[tuple[float, bool]] = []  # (monotonic time, live)
        threading.Thread(target=self._listen, daemon=True).start()
        self.port = self._ports.get(timeout=10)

    def _listen(self) -> None:
        for line in self._process.stdout:
            words = line.split()
            if words[:1] in (["live"], ["dead"]):
                self.changes.append((float(words[1]), words[0] == "live"))
            elif words[:1] == ["port"]:
                self._ports.put(words[1])
            elif words[:1] in (["output"], ["contacts"]):
                self._answers.put(words[1:])

    def say(self, word: str) -> None:
        """Inject a fault."""
        self._process.stdin.write(word + "\n")

    def replug(self) -> None:
        """Put the cable back."""
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

    def was_live_throughout(self, begin_s: float, end_s: float) -> bool:
        """Whether the output was live from `begin_s` to `end_s`."""
        before = [live for time_s, live in self.changes if time_s <= begin_s]
        within = [live for time_s, live in self.changes if begin_s < time_s <= end_s]
        return bool(before) and before[-1] and all(within)

    def close(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.wait()


class Bench:
    """A rig with the driver's thread on it, but no ROS."""

    def __init__(self, rig: Rig, limits: Limits | None = None) -> None:
        self.rig = rig
        self.statuses: list[Status] = []
        self.host_alive = True
        self.port = SerialPort(rig.port)
        supply = HaselSupply(self.port, limits or Limits())
        self.supervisor = Supervisor(supply, time.monotonic)
        self.supervisor.connect()
        self.thread = SupplyThread(self.supervisor, supply, self.statuses.append, self._step)
        self.thread.start()

    def _step(self) -> None:
        if self.host_alive:
            self.thread.host_is_alive()

    def call(self, method, *arguments):
        """Call a method of the supervisor in its thread."""
        return self.thread.call(lambda: method(*arguments)).result(timeout=10)

    def expect(self, condition, timeout_s: float = 2.0) -> bool:
        """Whether `condition()` comes true in time."""
        return self.thread.expect(condition, timeout_s).result(timeout=timeout_s + 5)

    def status(self) -> Status:
        """The present status."""
        return self.call(self.supervisor.status)

    def arm(self) -> None:
        """Arm, and wait for the proof."""
        assert self.expect(lambda: self.supervisor.status().mode.name == "STANDBY"), str(self.status())
        self.call(self.supervisor.arm)
        assert self.expect(lambda: self.supervisor.status().mode.name == "ARMED"), str(self.status())

    def hold(self, voltage: tuple[float, float], duration_s: float) -> None:
        """Command a voltage every 20 ms."""
        end_s = time.monotonic() + duration_s
        while time.monotonic() < end_s:
            self.call(self.supervisor.command, voltage)
            time.sleep(0.02)

    def drive_until_live(self, voltage: tuple[float, float] = (3000.0, -2000.0)) -> None:
        """Command a voltage until the output is truly live."""
        for _ in range(100):
            self.call(self.supervisor.command, voltage)
            time.sleep(0.02)
            if self.rig.live:
                return
        raise AssertionError(f"the output did not become live: {self.status()}")

    def false_claims(self, margin_s: float = 0.05) -> list[str]:
        """Statuses that called the output grounded, or claimed STANDBY, while it was live in truth."""
        return [
            str(status)
            for status in list(self.statuses)
            if (status.grounded or status.mode.name == "STANDBY")
            and self.rig.was_live_throughout(status.time_s - margin_s, status.time_s + margin_s)
        ]

    def close(self) -> None:
        """End the thread."""
        self.thread.stop()


class Conversation:
    """Talks to a board line by line, as its host's programmer would."""

    def __init__(self, port: str) -> None:
        self._port = SerialPort(port)
        self._port.open()
        self._lines = LineBuffer()
        self._sequence = 255
        self.events: list[protocol.Event] = []
        self.reports: list[protocol.Telemetry] = []
        self._replies: list[protocol.Reply] = []
        self.until(lambda: any(event.words[0] == "BOOT" for event in self.events))

    def send(self, data: bytes) -> None:
        """Raw bytes."""
        self._port.write(data)

    def ask(self, *words: object, sequence: int | None = None) -> tuple[bool, str]:
        """Whether a command was accepted, and the words of the reply."""
        self._sequence = (self._sequence + 1) % 256 if sequence is None else sequence
        self.send(protocol.encode_command(self._sequence, *words))
        return self.reply()

    def reply(self) -> tuple[bool, str]:
        """The next reply."""
        self.until(lambda: self._replies)
        reply = self._replies.pop(0)
        return reply.accepted, " ".join(reply.words)

    def report(self) -> protocol.Telemetry:
        """Telemetry of now."""
        self._take()
        time.sleep(0.03)
        self._take()
        self.reports.clear()
        self.until(lambda: self.reports)
        return self.reports[-1]

    def listen(self, duration_s: float, heartbeat: bool = True) -> list[protocol.Telemetry]:
        """Telemetry of a while."""
        self.reports.clear()
        end_s = time.monotonic() + duration_s
        while time.monotonic() < end_s:
            if heartbeat:
                self.ask("PING")
            self._take()
            time.sleep(0.02)
        return list(self.reports)

    def until(self, condition, timeout_s: float = 3.0) -> None:
        """Read until `condition()` holds."""
        end_s = time.monotonic() + timeout_s
        while not condition():
            assert time.monotonic() < end_s, "the board did not answer as expected"
            self._take()
            time.sleep(0.001)

    def _take(self) -> None:
        kinds = {protocol.Event: self.events, protocol.Telemetry: self.reports, protocol.Reply: self._replies}
        for line in self._lines.feed(self._port.read()):
            message = protocol.parse_device_line(line)
            kinds[type(message)].append(message)

    def close(self) -> None:
        """Close the port."""
        self._port.close()


@pytest.fixture(scope="session")
def firmware_build(tmp_path_factory) -> Path:
    """Folder with the compiled sketch and simulator."""
    missing = [name for name, program in NEEDED_PROGRAMS.items() if shutil.which(program) is None]
    missing += [name for name, file in NEEDED_FILES.items() if not Path(file).exists()]
    if missing:
        pytest.skip(f"the firmware needs Debian's packages {', '.join(missing)}")
    folder = tmp_path_factory.mktemp("firmware")
    subprocess.run(["make", "-s", "-C", str(FIRMWARE), "all", "simulator", f"BUILD={folder}"], check=True)
    return folder


def virtual_command() -> list[str]:
    """Command line of the virtual supply."""
    return [sys.executable, "-m", "hasel_driver.virtual_supply"]


@pytest.fixture(params=["virtual", "firmware"])
def rig_command(request) -> list[str]:
    """Command line of each kind of supply."""
    if request.param == "virtual":
        return virtual_command()
    build = request.getfixturevalue("firmware_build")
    return [str(build / "simulate"), str(build / "hasel_supply.elf")]


@pytest.fixture
def rig(rig_command):
    """A running supply."""
    rig = Rig(rig_command)
    yield rig
    rig.close()


@pytest.fixture
def virtual_rig():
    """A running virtual supply."""
    rig = Rig(virtual_command())
    yield rig
    rig.close()


@pytest.fixture
def firmware_rig(firmware_build):
    """The firmware, running in simavr."""
    rig = Rig([str(firmware_build / "simulate"), str(firmware_build / "hasel_supply.elf")])
    yield rig
    rig.close()


@pytest.fixture
def bench(rig):
    """A supply with the driver's thread on it."""
    bench = Bench(rig)
    yield bench
    bench.close()


@pytest.fixture
def converse():
    """Opens a conversation with a board that has just booted."""
    open_ones = []

    def begin(rig: Rig) -> Conversation:
        open_ones.append(Conversation(rig.port))
        return open_ones[-1]

    yield begin
    for conversation in open_ones:
        conversation.close()


@pytest.fixture
def board(rig, converse):
    """A conversation with a board that has just booted."""
    return converse(rig)
