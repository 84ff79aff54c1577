"""A supply in a process of its own, virtual or the firmware in simavr, that tells the truth about its output."""

import queue
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

from hasel_driver.realtime import request_realtime

PRIORITY = 50
VIRTUAL_SUPPLY = [sys.executable, "-m", "hasel_driver.virtual_supply"]


class Rig:
    """Starts `command`, which speaks as `virtual_supply` does on its standard input and output.

    `on_late` is told by how much the supply fell behind real time [s].
    """

    def __init__(self, command: list[str], on_late: Callable[[float], None] = lambda _: None) -> None:
        self._on_late = on_late
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
        )
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
        for line in self._process.stdout:
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
        self._process.stdin.write(word + "\n")

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
