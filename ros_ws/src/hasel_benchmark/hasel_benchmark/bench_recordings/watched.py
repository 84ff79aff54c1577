"""What a process and all that it started take: the most memory at once, and processor time."""

import threading
from contextlib import suppress

import psutil

LOOK_EVERY_S = 0.5


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
