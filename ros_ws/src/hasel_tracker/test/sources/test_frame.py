# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import threading
import time
from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.camera_source import CaptureThread
from hasel_tracker.sources.frame import DropOldestQueue, Frame, decoded_in_order, image_of

IMAGE = np.random.default_rng(4).integers(0, 256, (6, 8, 3), dtype=np.uint8)


def test_oldest_goes_first_and_is_counted():
    """Five items into three places: the two oldest are gone and counted, the rest comes in order."""
    queue = DropOldestQueue(3)
    for item in range(5):
        queue.put(item)
    assert queue.dropped == 2
    assert [queue.get() for _ in range(3)] == [2, 3, 4]


def test_get_waits_for_an_item_and_gives_up_when_closed():
    """A reader waits for a writer, gets None after its time-out, and is let go when the queue closes."""
    queue = DropOldestQueue(2)
    assert queue.get(timeout_s=0.01) is None
    threading.Timer(0.05, lambda: queue.put("late")).start()
    assert queue.get(timeout_s=2.0) == "late"
    threading.Timer(0.05, queue.close).start()
    assert queue.get(timeout_s=2.0) is None
    assert queue.closed


def test_slow_reader_does_not_hold_up_the_capture():
    """While the reader sleeps the camera is read on; the newest frames are kept, the others counted."""
    left = iter(range(200))

    def read() -> Frame | None:
        index = next(left, None)
        return None if index is None else Frame(index, index / 120)

    queue = DropOldestQueue(8)
    capture = CaptureThread(read, queue)
    start = time.monotonic()
    capture.start()
    while not queue.closed and time.monotonic() - start < 5.0:
        time.sleep(0.01)
    assert capture.captured == 200
    assert queue.dropped == 192
    assert [queue.get().index for _ in range(8)] == list(range(192, 200))


class SlowFrame(Frame):
    """Takes longer to decode the earlier it comes, so that later ones are ready first."""

    def decoded(self) -> Frame:
        time.sleep(0.02 if self.index % 3 == 0 else 0.001)
        return super().decoded()


def jpeg(value: int) -> bytes:
    """A small grey picture."""
    return cv2.imencode(".jpg", np.full((16, 16, 3), value, np.uint8))[1].tobytes()


@pytest.mark.parametrize("threads", [1, 2, 4])
def test_frames_come_out_in_order(threads):
    """With any number of threads, every frame comes once, decoded, in the order it came in."""
    frames = [SlowFrame(index, index / 120, jpeg=jpeg(10 * index)) for index in range(12)]
    out = list(decoded_in_order(iter(frames), threads, pytest.fail))
    assert [frame.index for frame in out] == list(range(12))
    assert [round(float(frame.image.mean())) for frame in out] == pytest.approx(
        [10 * k for k in range(12)], abs=2
    )


@pytest.mark.parametrize("threads", [1, 2])
def test_broken_picture_is_left_out_and_told(threads):
    """One broken JPEG among good ones is skipped, and the reason is handed on."""
    frames = [Frame(0, 0.0, jpeg=jpeg(50)), Frame(1, 0.1, jpeg=b"no jpeg"), Frame(2, 0.2, jpeg=jpeg(60))]
    told = []
    out = list(decoded_in_order(iter(frames), threads, told.append))
    assert [frame.index for frame in out] == [0, 2]
    assert "Frame 1 is not a readable JPEG picture" in str(told[0])


def test_waiting_frames_are_handed_on_when_none_comes():
    """A pause in the stream does not hold back the frames being decoded."""
    frames = iter([Frame(0, 0.0, jpeg=jpeg(50)), None, Frame(1, 0.1, jpeg=jpeg(60))])
    decoded = decoded_in_order(frames, 4, pytest.fail)
    assert next(decoded).index == 0


def message(encoding: str, pixels: np.ndarray, padding: int = 0) -> SimpleNamespace:
    """An image message; each row may be followed by padding."""
    rows = pixels.reshape(pixels.shape[0], -1)
    padded = np.hstack([rows, np.zeros((len(rows), padding), np.uint8)])
    return SimpleNamespace(
        encoding=encoding,
        is_bigendian=0,
        width=pixels.shape[1],
        height=len(rows),
        step=padded.shape[1],
        data=padded.tobytes(),
    )


@pytest.mark.parametrize("padding", [0, 5])
def test_orders_of_the_channels(padding):
    """BGR, RGB and RGBA messages, with or without padded rows, give the same BGR image."""
    opaque = np.full((6, 8, 1), 255, np.uint8)
    rgb = IMAGE[..., ::-1]
    for encoding, pixels in (("bgr8", IMAGE), ("rgb8", rgb), ("rgba8", np.dstack([rgb, opaque]))):
        assert (image_of(message(encoding, np.ascontiguousarray(pixels), padding)) == IMAGE).all()


@pytest.mark.parametrize("name", ["yuyv", "yuv422_yuy2", "uyvy", "yuv422", "nv12", "nv21"])
def test_yuv_messages_have_their_colours(name):
    """Every YUV encoding that ROS 2 Jazzy knows gives a plain colour back to a few levels."""
    colour = np.full((6, 8, 3), (40, 120, 200), np.uint8)
    planar = cv2.cvtColor(colour, cv2.COLOR_BGR2YUV_I420).ravel()
    luma, u, v = planar[0], planar[48], planar[60]
    packed = {
        "yuyv": [luma, u, luma, v],
        "uyvy": [u, luma, v, luma],
        "nv12": [u, v],
        "nv21": [v, u],
    }
    kind = {"yuv422_yuy2": "yuyv", "yuv422": "uyvy"}.get(name, name)
    if kind.startswith("nv"):
        rows = np.vstack([np.full((6, 8), luma), np.tile(packed[kind], (3, 4))]).astype(np.uint8)
        sent = message(name, rows[..., None])
        sent.height = 6
    else:
        sent = message(name, np.tile(packed[kind], (6, 4)).astype(np.uint8).reshape(6, 8, 2))
    assert np.abs(image_of(sent).astype(int) - colour).max() <= 4


@pytest.mark.parametrize("order", ["<u2", ">u2"])
def test_16_bit_messages(order):
    """The upper byte of a 16-bit channel is what is seen, whatever the order of its bytes."""
    sent = message("rgb16", (IMAGE[..., ::-1].astype(np.uint16) * 257).astype(order).view(np.uint8))
    sent.width, sent.is_bigendian = 8, int(order == ">u2")
    assert (image_of(sent) == IMAGE).all()


def test_bayer_pattern_has_the_colours_right():
    """A raw picture that is blue everywhere comes out blue: the pattern is not shifted."""
    raw = np.zeros((8, 8), np.uint8)
    raw[1::2, 1::2] = 200  # blue sites of an RGGB sensor
    blue, green, red = image_of(message("bayer_rggb8", raw[..., None]))[4, 4]
    assert blue > 150
    assert max(int(green), int(red)) < 20


def test_compressed_image():
    """A PNG message gives the picture exactly."""
    data = cv2.imencode(".png", IMAGE)[1].tobytes()
    assert (image_of(SimpleNamespace(format="png", data=data)) == IMAGE).all()


@pytest.mark.parametrize(
    ("broken", "expected"),
    [
        (message("mono8", IMAGE[..., :1]), "sends 'mono8'; expected a colour image"),
        (
            SimpleNamespace(encoding="bgr8", width=9, height=9, step=27, data=b"123"),
            "sends 3 bytes for 9 × 9",
        ),
        (SimpleNamespace(format="jpeg", data=b"garbage"), "cannot be decoded"),
    ],
)
def test_unusable_messages_are_explained(broken, expected):
    """A grey, truncated or broken message is named for what it is."""
    with pytest.raises(TrackerError, match=expected):
        image_of(broken)
