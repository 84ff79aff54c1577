"""Runs, and the rests between them, in a stream of the supply's states."""

from collections.abc import Sequence

from hasel_sysid.live.driven_parts import AFTER_S, REST_S


class DriveWatch:
    """Told of states one after the other, as `driven_parts` cuts the whole stream; a voltage holds until the next."""

    def __init__(self) -> None:
        self._epoch: int | None = None
        self._driven = False
        self._resting_since_ns = 0
        self._last_rest_ns: tuple[float, float] | None = None

    def begins(self, epoch: int, stamp_ns: int, voltage: Sequence[float]) -> bool:
        """Whether a run begins with this state; a voltage [V] that is not known (NaN) drives nothing."""
        if epoch != self._epoch:
            self._epoch, self._driven = epoch, False
            self._resting_since_ns, self._last_rest_ns = stamp_ns, None
        was_driven, self._driven = self._driven, any(abs(each) > 0 for each in voltage)
        if was_driven and not self._driven:
            self._resting_since_ns, self._last_rest_ns = stamp_ns, (stamp_ns, float("inf"))
        if was_driven or not self._driven:
            return False
        if self._last_rest_ns is not None:
            self._last_rest_ns = self._resting_since_ns, stamp_ns
        return stamp_ns - self._resting_since_ns > REST_S * 1e9

    def is_over(self, epoch: int, stamp_ns: int) -> bool:
        """Whether the body, once driven, has come to rest by a stamp [ns], which may lie before the last state."""
        if epoch != self._epoch or self._last_rest_ns is None:
            return False
        since_ns, until_ns = self._last_rest_ns
        return since_ns + AFTER_S * 1e9 < stamp_ns < until_ns
