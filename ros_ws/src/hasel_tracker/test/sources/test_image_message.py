from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.image_message import image_of

IMAGE = np.random.default_rng(4).integers(0, 256, (6, 8, 3), dtype=np.uint8)


def message(encoding: str, pixels: np.ndarray, padding: int = 0) -> SimpleNamespace:
    """An image message; each row may be followed by padding."""
    rows = pixels.reshape(pixels.shape[0], -1)
    padded = np.hstack([rows, np.zeros((len(rows), padding), np.uint8)])
    return SimpleNamespace(
        encoding=encoding,
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
