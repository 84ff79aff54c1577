"""A camera that is opened again when it was unplugged."""

import threading
from collections.abc import Callable

from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.camera_source import CameraSource
from hasel_tracker.sources.frame import Frame

RETRY_S = 1.0


class PersistentCamera:
    """Reads from the camera that `open_camera` opens; the first opening raises TrackerError if it fails."""

    def __init__(self, open_camera: Callable[[], CameraSource], retry_s: float = RETRY_S) -> None:
        self._open = open_camera
        self._retry_s = retry_s
        self._closing = threading.Event()
        self.camera: CameraSource | None = open_camera()
        self.fault = ""

    def read(self) -> Frame | None:
        """The next frame; waits for the camera to come back if it is gone; None after `close`."""
        while not self._closing.is_set():
            frame = None if self.camera is None else self.camera.read()
            if frame is not None:
                self.fault = ""
                return frame
            self._reopen()
        return None

    def close(self) -> None:
        """Stop waiting for frames."""
        self._closing.set()

    def release(self) -> None:
        """Leave the camera to others, once nobody reads any more."""
        self.close()
        if self.camera is not None:
            self.camera.close()
            self.camera = None

    def _reopen(self) -> None:
        if self.camera is not None:
            self.camera.close()
            self.camera = None
            self.fault = "The camera stopped sending frames; check its cable."
        if self._closing.wait(self._retry_s):
            return
        try:
            self.camera = self._open()
        except TrackerError as error:
            self.fault = str(error)
