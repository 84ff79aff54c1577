"""The error of the run that is going on."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hasel_sysid.live.drive_watch import DriveWatch
from hasel_sysid.live.pairing import Pair


@dataclass(frozen=True)
class RunningError:
    """difference: simulated minus measured sin theta; count: pairs of this run so far.

    mean_absolute: mean |Δ sin θ| of the run so far; recent: the same over the last `window` seconds of it.
    """

    difference: float
    mean_absolute: float
    count: int
    recent: float
    window: float


class RunningErrors:
    """Sums up pair by pair; every run begins anew, so that a better model shows at once.

    As in `compare`, the offset between simulated and measured angle is unknown: the mean difference of the run so far,
    or of the window, is taken out before the mean of the magnitudes. While the body rests after its drive nothing is
    added: waiting would make the error smaller. reset: a longer gap [s] between pairs begins a new run; window [s]: of
    the recent error.
    """

    def __init__(self, reset: float, window: float) -> None:
        self._reset_ns, self._window = reset * 1e9, window
        self._drive = DriveWatch()
        self._last: Pair | None = None
        self._latest: RunningError | None = None
        self._begins: tuple[int, int] | None = None
        self._differences, self._stamps = np.empty(0), np.empty(0, dtype=np.int64)
        self._count = 0

    def state(self, epoch: int, stamp_ns: int, voltage: Sequence[float]) -> None:
        """What drives the body [V] from a stamp [ns] on; where a run begins by it, pairs from there on are its own."""
        if self._drive.begins(epoch, stamp_ns, voltage):
            self._begins = epoch, stamp_ns

    def add(self, pair: Pair) -> RunningError:
        """The error after one more pair; of the run that is over, but for the difference, while the body rests."""
        if self._latest is not None and self._drive.is_over(pair.epoch, pair.stamp_ns):
            self._latest = replace(self._latest, difference=pair.difference)
            return self._latest
        if self._is_another_run(pair):
            self._count = 0
        self._last = pair
        if self._count == len(self._differences):
            size = max(1024, 2 * self._count)
            self._differences = np.resize(self._differences, size)
            self._stamps = np.resize(self._stamps, size)
        self._differences[self._count], self._stamps[self._count] = pair.difference, pair.stamp_ns
        self._count += 1
        so_far, stamps = self._differences[: self._count], self._stamps[: self._count]
        first = np.searchsorted(stamps, pair.stamp_ns - round(self._window * 1e9))
        self._latest = RunningError(
            pair.difference, _about_mean(so_far), self._count, _about_mean(so_far[first:]), self._window
        )
        return self._latest

    def _is_another_run(self, pair: Pair) -> bool:
        if self._begins is not None and (pair.epoch, pair.stamp_ns) >= self._begins:
            self._begins = None
            return True
        last = self._last
        return last is None or pair.epoch != last.epoch or pair.stamp_ns - last.stamp_ns > self._reset_ns


def _about_mean(differences: np.ndarray) -> float:
    return float(np.abs(differences - differences.mean()).mean())
