"""Whether this machine kept time: a test against the clock proves nothing on one that did not."""

import os
import threading
import time
import tty
from collections.abc import Callable

PERIOD_S = 0.01
TOLERANCE_S = 0.05


class Punctuality:
    """Measures in the background how late a thread is woken, and a byte is passed on by a pseudo-terminal.

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
