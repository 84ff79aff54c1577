"""Aligns the board's clock with the host's, so that telemetry is stamped when it was measured."""

import math
from collections import deque

_WRAP_US = 2**32


class DeviceClock:
    """Maps the board's microseconds to host seconds.

    A line can only arrive late, never early, so the least (arrival − device time) of the last `window_s`
    seconds is the best offset; the window lets it follow the drift of the board's resonator.
    """

    def __init__(self, window_s: float = 10.0) -> None:
        self._window_s = window_s
        self._offsets: deque[tuple[float, float]] = deque()  # (arrival, offset), offsets increasing
        self._last_us: int | None = None
        self._wraps = 0
        self._last_s = -math.inf

    def host_time(self, device_us: int, arrival_s: float) -> float:
        """Host time [s] at which the board's clock showed `device_us`; increasing, at most `arrival_s`."""
        if self._last_us is not None and device_us < self._last_us - _WRAP_US // 2:
            self._wraps += 1
        self._last_us = device_us
        device_s = (device_us + self._wraps * _WRAP_US) * 1e-6
        offset = arrival_s - device_s
        while self._offsets and self._offsets[-1][1] >= offset:
            self._offsets.pop()
        self._offsets.append((arrival_s, offset))
        while self._offsets[0][0] < arrival_s - self._window_s:
            self._offsets.popleft()
        # A better offset moves time back: do not let two reports change order.
        self._last_s = min(max(device_s + self._offsets[0][1], self._last_s + 1e-6), arrival_s)
        return self._last_s
