# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""One picture on its way from a source to the tracker: the queue in which it waits, and how it is decoded."""

import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any, Generic, TypeVar

import cv2
import numpy as np

from hasel_tracker.errors import TrackerError

Item = TypeVar("Item")
ENCODINGS: dict[str, tuple[int, int | None]] = {
    "bgr": (3, None),
    "rgb": (3, cv2.COLOR_RGB2BGR),
    "bgra": (4, cv2.COLOR_BGRA2BGR),
    "rgba": (4, cv2.COLOR_RGBA2BGR),
    "bayer_rggb": (1, cv2.COLOR_BayerBG2BGR),
    "bayer_bggr": (1, cv2.COLOR_BayerRG2BGR),
    "bayer_gbrg": (1, cv2.COLOR_BayerGR2BGR),
    "bayer_grbg": (1, cv2.COLOR_BayerGB2BGR),
}
"""Channels and conversion of what sensor_msgs calls so, with 8 or 16 bits after it."""
TO_BGR = {f"{name}{bits}": (*how, bits // 8) for name, how in ENCODINGS.items() for bits in (8, 16)} | {
    "yuv422_yuy2": (2, cv2.COLOR_YUV2BGR_YUY2, 1),
    "yuyv": (2, cv2.COLOR_YUV2BGR_YUY2, 1),
    "yuv422": (2, cv2.COLOR_YUV2BGR_UYVY, 1),
    "uyvy": (2, cv2.COLOR_YUV2BGR_UYVY, 1),
    "nv12": (1, cv2.COLOR_YUV2BGR_NV12, 1),
    "nv21": (1, cv2.COLOR_YUV2BGR_NV21, 1),
}
"""Channels, conversion and bytes per channel of every encoding."""
HALF_COLOURS = {"nv12", "nv21"}  # half as many rows again hold the colours


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


def decoded_in_order(
    frames: Iterable[Frame | None], threads: int, broken: Callable[[TrackerError], None]
) -> Iterator[Frame]:
    """Decoded frames in the order of `frames`, at most `threads` of them being decoded at a time.

    None among the frames means that none has come lately: what is waiting is handed on. A frame that cannot
    be decoded is left out and `broken` is told why. With one thread, decoding is done in the calling one.
    """
    if threads == 1:
        yield from _decoded_here(frames, broken)
        return
    with ThreadPoolExecutor(threads, thread_name_prefix="decode") as pool:
        waiting: deque[Future[Frame]] = deque()
        for frame in frames:
            if frame is not None:
                waiting.append(pool.submit(frame.decoded))
            while waiting and (frame is None or len(waiting) >= threads or waiting[0].done()):
                yield from _result(waiting.popleft().result, broken)
        while waiting:
            yield from _result(waiting.popleft().result, broken)


def _decoded_here(frames: Iterable[Frame | None], broken: Callable[[TrackerError], None]) -> Iterator[Frame]:
    for frame in frames:
        if frame is not None:
            yield from _result(frame.decoded, broken)


def _result(decode: Callable[[], Frame], broken: Callable[[TrackerError], None]) -> Iterator[Frame]:
    try:
        yield decode()
    except TrackerError as error:
        broken(error)


def image_of(message: Any) -> np.ndarray:
    """8-bit BGR image, shape (height, width, 3), of a sensor_msgs Image or CompressedImage."""
    return _compressed(message) if hasattr(message, "format") else _raw(message)


def _raw(message: Any) -> np.ndarray:
    if message.encoding not in TO_BGR:
        raise TrackerError(
            f"The image topic sends '{message.encoding}'; expected a colour image: set the camera driver to one of "
            f"{', '.join(TO_BGR)}."
        )
    channels, conversion, depth = TO_BGR[message.encoding]
    lines = message.height * 3 // 2 if message.encoding in HALF_COLOURS else message.height
    data, row = np.frombuffer(message.data, np.uint8), message.width * channels * depth
    if message.step < row or data.size < message.step * lines:
        raise TrackerError(
            f"The image topic sends {data.size} bytes for {message.width} × {message.height} px "
            f"'{message.encoding}'; check the camera driver."
        )
    pixels = np.ascontiguousarray(data[: message.step * lines].reshape(lines, message.step)[:, :row])
    if depth == 2:
        pixels = (pixels.view(">u2" if message.is_bigendian else "<u2") >> 8).astype(np.uint8)
    pixels = pixels if channels == 1 else pixels.reshape(lines, message.width, channels)
    return pixels if conversion is None else cv2.cvtColor(pixels, conversion)


def _compressed(message: Any) -> np.ndarray:
    image = cv2.imdecode(np.frombuffer(message.data, np.uint8), cv2.IMREAD_COLOR)
    if image is None:
        raise TrackerError(
            f"The image topic sends '{message.format}' that cannot be decoded; expected JPEG or PNG: check its driver."
        )
    return image
