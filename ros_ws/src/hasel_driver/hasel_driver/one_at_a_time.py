"""A place for one: promised when a goal is accepted, taken when it begins."""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from hasel_driver.errors import RefusedError

PROMISE_S = 2.0


class OneAtATime:
    """Between the acceptance of a goal and its begin other goals may arrive: the promise keeps them out.

    A goal whose acceptance could not be sent never begins, so a promise lapses after `PROMISE_S`.
    """

    def __init__(self, clock_s: Callable[[], float] = time.monotonic) -> None:
        self._clock_s = clock_s
        self._lock = threading.Lock()
        self._taken = False
        self._promised_until_s = -float("inf")

    def promise(self) -> bool:
        """Whether the place is free; if so it is kept for who asked."""
        with self._lock:
            if self._taken or self._clock_s() < self._promised_until_s:
                return False
            self._promised_until_s = self._clock_s() + PROMISE_S
            return True

    @contextmanager
    def taken(self) -> Iterator[None]:
        """Hold the place. Raises RefusedError where another holds it."""
        with self._lock:
            if self._taken:
                raise RefusedError("Another experiment is running: wait for its end, or cancel it.")
            self._taken = True
            self._promised_until_s = -float("inf")
        try:
            yield
        finally:
            with self._lock:
                self._taken = False
