"""Play a recorded video or folder as if it were a camera."""

import time
from collections.abc import Iterable, Iterator
from dataclasses import replace

from hasel_tracker.sources.frame import Frame


class Playback:
    """Gives each frame when its time has come, stamped with the start of the playback plus the frame's own time."""

    def __init__(self, frames: Iterable[Frame]) -> None:
        self._frames: Iterator[Frame] = iter(frames)
        self._start: float | None = None
        self._start_ns = 0

    def read(self) -> Frame | None:
        """The next frame, when it is due; None at the end."""
        frame = next(self._frames, None)
        if frame is None:
            return None
        now = time.monotonic()
        if self._start is None:
            self._start, self._start_ns = now - frame.time_s, time.time_ns() - round(frame.time_s * 1e9)
        time.sleep(max(self._start + frame.time_s - now, 0.0))
        return replace(frame, stamp_ns=self._start_ns + round(frame.time_s * 1e9))
