"""Read a camera as fast as it delivers, whatever the tracker does."""

import threading
from collections.abc import Callable

from hasel_tracker.sources.frame import Frame
from hasel_tracker.sources.frame_queue import DropOldestQueue


class CaptureThread:
    """Puts every frame that `read` returns into `queue`, until it returns None or `stop` is called."""

    def __init__(self, read: Callable[[], Frame | None], queue: DropOldestQueue[Frame]) -> None:
        self._read = read
        self._queue = queue
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="capture", daemon=True)
        self.captured = 0

    def start(self) -> None:
        """Begin to read."""
        self._thread.start()

    def stop(self) -> None:
        """Stop after the frame being read, and wait for it."""
        self._stopping.set()
        if self._thread.is_alive():
            self._thread.join(timeout=2.0)

    def _run(self) -> None:
        try:
            while not self._stopping.is_set():
                frame = self._read()
                if frame is None:
                    return
                self.captured += 1
                self._queue.put(frame)
        finally:
            self._queue.close()
