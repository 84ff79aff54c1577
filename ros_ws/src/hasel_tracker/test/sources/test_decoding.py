import time

import cv2
import numpy as np
import pytest
from hasel_tracker.sources.decoding import decoded_in_order
from hasel_tracker.sources.frame import Frame


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
