"""Telling one run from the next in streams that arrive independently."""


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
