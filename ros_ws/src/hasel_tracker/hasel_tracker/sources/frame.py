"""One picture on its way from a source to the tracker, and the queue in which it waits."""

import threading
from collections import deque
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

import cv2
import numpy as np

from hasel_tracker.errors import TrackerError

Item = TypeVar("Item")


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


class DropOldestQueue(Generic[Item]):
    """Never blocks the writer; counts what it drops."""

    def __init__(self, capacity: int) -> None:
        self._items: deque[Item] = deque()
        self._capacity = capacity
        self._changed = threading.Condition()
        self._dropped = 0
        self._closed = False

    @property
    def dropped(self) -> int:
        """How many items were dropped so far."""
        return self._dropped

    def put(self, item: Item) -> None:
        """Append an item; the oldest one goes if there is no room."""
        with self._changed:
            if len(self._items) == self._capacity:
                self._items.popleft()
                self._dropped += 1
            self._items.append(item)
            self._changed.notify()

    def get(self, timeout_s: float | None = None) -> Item | None:
        """The oldest item; None after `timeout_s`, or when the queue is closed and empty."""
        with self._changed:
            self._changed.wait_for(lambda: self._items or self._closed, timeout_s)
            return self._items.popleft() if self._items else None

    def close(self) -> None:
        """Let waiting readers go once the queue is empty."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    @property
    def closed(self) -> bool:
        """Whether no more items will come."""
        return self._closed

    def __len__(self) -> int:
        return len(self._items)
