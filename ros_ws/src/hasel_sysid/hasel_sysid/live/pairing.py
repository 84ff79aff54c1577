"""Bringing measured and simulated angles of the same instant together."""

from bisect import bisect_left
from collections import deque
from dataclasses import dataclass

import numpy as np

_KEPT = 20_000
"""Messages of either kind that may wait for the other."""


@dataclass(frozen=True)
class Pair:
    """Measured and simulated sin theta at a stamp [ns] of an epoch."""

    epoch: int
    stamp_ns: int
    measured: float
    simulated: float

    @property
    def difference(self) -> float:
        """Simulated minus measured."""
        return self.simulated - self.measured


class Pairing:
    """Pairs by stamp; a camera's stamp between two of the supply's gets the simulated angle interpolated linearly.

    gap: no interpolation between simulated angles further apart [s]. Frames without a measured angle are left out.
    """

    def __init__(self, gap: float) -> None:
        self._gap_ns = gap * 1e9
        self._measured: deque[tuple[int, int, float]] = deque(maxlen=_KEPT)
        self._simulated: deque[tuple[int, int, float]] = deque(maxlen=_KEPT)

    def measured(self, epoch: int, stamp_ns: int, sin_theta: float) -> list[Pair]:
        """Add a measured angle and return the pairs that are complete by it."""
        if np.isfinite(sin_theta):
            self._measured.append((epoch, stamp_ns, sin_theta))
        return self._complete()

    def simulated(self, epoch: int, stamp_ns: int, sin_theta: float) -> list[Pair]:
        """Add a simulated angle and return the pairs that are complete by it."""
        self._simulated.append((epoch, stamp_ns, sin_theta))
        return self._complete()

    def _complete(self) -> list[Pair]:
        pairs = []
        while self._measured and self._simulated and self._measured[0][:2] <= self._simulated[-1][:2]:
            epoch, stamp_ns, sine = self._measured.popleft()
            at = self._interpolated(epoch, stamp_ns)
            if at is not None:
                pairs.append(Pair(epoch, stamp_ns, sine, at))
        return pairs

    def _interpolated(self, epoch: int, stamp_ns: int) -> float | None:
        index = bisect_left(self._simulated, (epoch, stamp_ns), key=lambda entry: entry[:2])
        after = self._simulated[index]
        if after[:2] == (epoch, stamp_ns):
            return after[2]
        before = self._simulated[index - 1] if index else after
        width = after[1] - before[1]
        if not before[0] == after[0] == epoch or not 0 < width <= self._gap_ns:
            return None
        return before[2] + (after[2] - before[2]) * (stamp_ns - before[1]) / width
