# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a command takes: by the clock, processor time of all that took part, and the most memory at once."""

import resource
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass

import psutil

from hasel_benchmark.errors import BenchmarkError

LOOK_EVERY_S = 0.5


@dataclass(frozen=True)
class Took:
    """One call of a command: by the clock on the wall, and processor time of the command and of the workers [s]."""

    wall_s: float
    command_s: float
    workers_s: float


def timed(module: str, arguments: Sequence[str], of_workers: Callable[[], float]) -> Took:
    """Run a command's module; of_workers: processor time of the workers until now [s].

    Raises BenchmarkError with what the command said where it fails.
    """
    before, begin, own = of_workers(), time.perf_counter(), _of_ended_processes()
    done = subprocess.run(
        [sys.executable, "-m", module, *arguments], check=False, capture_output=True, text=True
    )
    wall = time.perf_counter() - begin
    if done.returncode:
        raise BenchmarkError(f"{module} gave {done.returncode}: {done.stderr.strip()[-500:]}")
    return Took(wall, _of_ended_processes() - own, of_workers() - before)


def _of_ended_processes() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Watched:
    """What is started while the body of a `with` runs.

    peak_bytes: the most memory that all took at once; pages that several share are counted once, a part in each
    (proportional set size, Linux). processor_s: of all, as far as it was seen, each up to `LOOK_EVERY_S` before its
    end.
    """

    def __init__(self) -> None:
        self.peak_bytes = 0
        self._seconds: dict[psutil.Process, float] = {}
        self._before: set[psutil.Process] = set()
        self._ends = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)

    @property
    def processor_s(self) -> float:
        """Of all processes that were seen [s]."""
        return sum(self._seconds.values())

    def __enter__(self) -> "Watched":
        self._before = set(psutil.Process().children(recursive=True))
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._ends.set()
        self._thread.join()

    def _watch(self) -> None:
        while not self._ends.wait(LOOK_EVERY_S):
            started = set(psutil.Process().children(recursive=True)) - self._before
            self.peak_bytes = max(self.peak_bytes, sum(map(self._look, started)))

    def _look(self, process: psutil.Process) -> int:
        """Bytes that it takes now."""
        with suppress(psutil.Error):  # it has just ended
            times = process.cpu_times()
            self._seconds[process] = times.user + times.system
            return process.memory_full_info().pss
        return 0
