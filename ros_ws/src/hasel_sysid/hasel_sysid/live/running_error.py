# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The error of the run that is going on, from streams that arrive independently and are brought together."""

from bisect import bisect_left
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hasel_sysid.live.heard import DriveWatch

_KEPT = 20_000
"""Messages of either kind that may wait for the other."""


class Epochs:
    """A number that all streams share: it grows when stamps go back, as they do when a recording is replayed again."""

    def __init__(self) -> None:
        self.newest = 0


class StreamEpoch:
    """One stream's epoch. late: stamps that go back by no more than this [s] do not begin a new one."""

    def __init__(self, epochs: Epochs, late: float) -> None:
        self._epochs, self._late = epochs, late
        self._newest_ns: int | None = None
        self._epoch = 0

    def of(self, stamp_ns: int) -> int:
        """The epoch that a message with this stamp [ns] belongs to."""
        if self._newest_ns is None:
            self._epoch = self._epochs.newest
        elif stamp_ns < self._newest_ns - self._late * 1e9:
            self._epoch = max(self._epoch + 1, self._epochs.newest)
            self._newest_ns = None
        self._epochs.newest = max(self._epochs.newest, self._epoch)
        self._newest_ns = stamp_ns if self._newest_ns is None else max(self._newest_ns, stamp_ns)
        return self._epoch


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
