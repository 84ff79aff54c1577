"""A command by the clock, and the processor time of all that took part."""

import resource
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from hasel_benchmark.errors import BenchmarkError


@dataclass(frozen=True)
class Took:
    """One call of a command: by the clock on the wall, and processor time of the command and of the workers [s]."""

    wall_s: float
    command_s: float
    workers_s: float

    @property
    def processor_s(self) -> float:
        """Of all together."""
        return self.command_s + self.workers_s


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
