"""How long a search may take."""

import math
import time
from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

Work = TypeVar("Work")

_BATCH = 8


class TimeLimit:
    """From its making. `is_over` is asked before each piece of work that could be left out; none is broken off."""

    def __init__(self, seconds: float = math.inf, clock: Callable[[], float] = time.monotonic) -> None:
        """clock: what tells the time, in seconds."""
        self.seconds, self._clock = seconds, clock
        self._began = clock()
        self.left_something_out = False

    def is_over(self) -> bool:
        """Whether so many seconds have gone by; who is told so leaves its work out, which is remembered."""
        over = self._clock() - self._began > self.seconds
        self.left_something_out |= over
        return over

    def in_batches(self, pieces: Sequence[Work], even_late: bool = False) -> Iterator[Sequence[Work]]:
        """Eight pieces of work at a time, to be done side by side, until time is over; even_late: the first eight in
        any case.
        """
        for begin in range(0, len(pieces), _BATCH):
            if not (even_late and begin == 0) and self.is_over():
                return
            yield pieces[begin : begin + _BATCH]

    def __str__(self) -> str:
        return f"the limit of {self.seconds:g} s"
