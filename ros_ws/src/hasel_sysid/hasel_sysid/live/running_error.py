"""The error of the run that is going on."""

from dataclasses import dataclass

import numpy as np

from hasel_sysid.live.pairing import Pair


@dataclass(frozen=True)
class RunningError:
    """difference: simulated minus measured sin theta; mean_absolute: mean |Δ sin θ| of the run so far; count: pairs."""

    difference: float
    mean_absolute: float
    count: int


class RunningErrors:
    """Sums up pair by pair; every run begins anew, so that a better model shows at once.

    As in `compare`, the offset between simulated and measured angle is unknown: the mean difference of the run so far
    is taken out before the mean of the magnitudes. reset: a longer gap [s] between pairs begins a new run.
    """

    def __init__(self, reset: float) -> None:
        self._reset_ns = reset * 1e9
        self._last: Pair | None = None
        self._differences = np.empty(0)
        self._count = 0

    def add(self, pair: Pair) -> RunningError:
        """The error after one more pair."""
        last = self._last
        if last is None or pair.epoch != last.epoch or pair.stamp_ns - last.stamp_ns > self._reset_ns:
            self._count = 0
        self._last = pair
        if self._count == len(self._differences):
            self._differences = np.resize(self._differences, max(1024, 2 * self._count))
        self._differences[self._count] = pair.difference
        self._count += 1
        so_far = self._differences[: self._count]
        return RunningError(pair.difference, float(np.abs(so_far - so_far.mean()).mean()), self._count)
