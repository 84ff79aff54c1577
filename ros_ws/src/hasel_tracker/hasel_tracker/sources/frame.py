"""One picture on its way from a source to the tracker."""

from dataclasses import dataclass, replace

import cv2
import numpy as np

from hasel_tracker.errors import TrackerError


@dataclass(frozen=True)
class Frame:
    """An image, or its JPEG code not yet decoded, with the time it was taken.

    image: 8-bit BGR, shape (height, width, 3), or None. jpeg: the picture's JPEG bytes, or None. time_s:
    time since the source's first frame [s]. stamp_ns: time of capture since the epoch [ns], or None if the
    source does not know.
    """

    index: int
    time_s: float
    image: np.ndarray | None = None
    jpeg: bytes | None = None
    stamp_ns: int | None = None

    def decoded(self) -> "Frame":
        """The frame with its image; raises TrackerError if the JPEG code is broken."""
        if self.image is not None:
            return self
        image = cv2.imdecode(np.frombuffer(self.jpeg, np.uint8), cv2.IMREAD_COLOR)
        if image is None:
            raise TrackerError(
                f"Frame {self.index} is not a readable JPEG picture ({len(self.jpeg)} bytes); "
                "check the cable and the camera's pixel format."
            )
        return replace(self, image=image)
