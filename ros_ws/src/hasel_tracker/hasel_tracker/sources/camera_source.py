# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A camera through OpenCV: what was asked of it, stamped frames, a thread that reads; opened again when unplugged."""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import cv2
import numpy as np

from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.frame import DropOldestQueue, Frame

RATE_SHARE = 0.95
RATE_TOLERANCE = 0.005  # drivers give 119.98 for 120
LONGEST_CLOCK_DIFFERENCE_S = 2.0
RETRY_S = 1.0


@dataclass(frozen=True)
class CameraFormat:
    """Width and height [px], frame rate [1/s] and four-character pixel format."""

    width: int = 1920
    height: int = 1080
    frame_rate_hz: float = 120.0
    pixel_format: str = "MJPG"

    def __str__(self) -> str:
        return f"{self.width} × {self.height} px {self.pixel_format} at {self.frame_rate_hz:g} frames/s"


class CameraSource:
    """An open camera. `exposure` in the driver's units; None leaves it to the camera."""

    def __init__(
        self,
        device: int | str,
        asked: CameraFormat = CameraFormat(),
        exposure: float | None = None,
        capture: cv2.VideoCapture | None = None,
    ) -> None:
        self._capture = capture if capture is not None else cv2.VideoCapture(device, cv2.CAP_V4L2)
        if not self._capture.isOpened():
            raise TrackerError(
                f"The camera {device} cannot be opened; check that it is plugged in, not in use by "
                f"another program, "
                "and readable for you (group `video`)."
            )
        self.asked = asked
        self._configure(exposure)
        self.given = self._read_back()
        self._index = 0
        self._first_ns: int | None = None

    @property
    def complaint(self) -> str:
        """One sentence if the camera does not give what was asked for, else empty."""
        same_rate = abs(self.given.frame_rate_hz / self.asked.frame_rate_hz - 1.0) < RATE_TOLERANCE
        if replace(self.given, frame_rate_hz=0.0) == replace(self.asked, frame_rate_hz=0.0) and same_rate:
            return ""
        return f"Asked the camera for {self.asked}, it gives {self.given}."

    def read(self) -> Frame | None:
        """The next frame, decoded or as JPEG, stamped by the driver if it can; None if the camera fails."""
        received, picture = self._capture.read()
        if not received or picture is None:
            return None
        stamp_ns = self._stamp_ns()
        self._first_ns = stamp_ns if self._first_ns is None else self._first_ns
        index, self._index = self._index, self._index + 1
        time_s = (stamp_ns - self._first_ns) * 1e-9
        if picture.ndim == 3 and picture.shape[2] == 3:
            return Frame(index, time_s, image=picture, stamp_ns=stamp_ns)
        return Frame(index, time_s, jpeg=picture.astype(np.uint8).tobytes(), stamp_ns=stamp_ns)

    def close(self) -> None:
        """Release the device."""
        self._capture.release()

    def _configure(self, exposure: float | None) -> None:
        # The pixel format comes first: it decides which sizes and rates there are.
        self._capture.set(cv2.CAP_PROP_FOURCC, cv2.VideoWriter_fourcc(*self.asked.pixel_format))  # type: ignore[attr-defined]
        self._capture.set(cv2.CAP_PROP_FRAME_WIDTH, self.asked.width)
        self._capture.set(cv2.CAP_PROP_FRAME_HEIGHT, self.asked.height)
        self._capture.set(cv2.CAP_PROP_FPS, self.asked.frame_rate_hz)
        if self.asked.pixel_format == "MJPG":
            # Leave decoding to several threads of ours: one cannot keep up with 1080p at 120 frames/s.
            self._capture.set(cv2.CAP_PROP_CONVERT_RGB, 0)
        if exposure is not None:
            self._capture.set(cv2.CAP_PROP_AUTO_EXPOSURE, 1)
            self._capture.set(cv2.CAP_PROP_EXPOSURE, exposure)

    def _read_back(self) -> CameraFormat:
        code = int(self._capture.get(cv2.CAP_PROP_FOURCC))
        letters = "".join(chr((code >> shift) & 0xFF) for shift in (0, 8, 16, 24))
        return CameraFormat(
            int(self._capture.get(cv2.CAP_PROP_FRAME_WIDTH)),
            int(self._capture.get(cv2.CAP_PROP_FRAME_HEIGHT)),
            float(self._capture.get(cv2.CAP_PROP_FPS)),
            letters,
        )

    def _stamp_ns(self) -> int:
        """The driver's stamp of exposure (monotonic clock) since the epoch; else the time of arrival."""
        now_ns = time.time_ns()
        age_s = time.monotonic() - 1e-3 * self._capture.get(cv2.CAP_PROP_POS_MSEC)
        if 0.0 <= age_s < LONGEST_CLOCK_DIFFERENCE_S:
            return now_ns - round(age_s * 1e9)
        return now_ns


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
