"""Play a recorded video or folder as if it were a camera."""

import time
from collections.abc import Iterable, Iterator
from dataclasses import replace

from hasel_tracker.sources.frame import Frame


class Playback:
    """Gives each frame when its time has come, stamped with the time it is given."""

    def __init__(self, frames: Iterable[Frame]) -> None:
        self._frames: Iterator[Frame] = iter(frames)
        self._start: float | None = None

    def read(self) -> Frame | None:
        """The next frame, when it is due; None at the end."""
        frame = next(self._frames, None)
        if frame is None:
            return None
        now = time.monotonic()
        self._start = now - frame.time_s if self._start is None else self._start
        time.sleep(max(self._start + frame.time_s - now, 0.0))
        return replace(frame, stamp_ns=time.time_ns())
