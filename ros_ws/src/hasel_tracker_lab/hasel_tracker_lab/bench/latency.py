"""Time from a frame's capture to its angle, as the node captures, decodes and tracks."""

import itertools
import threading
import time
from dataclasses import dataclass

import cv2
import numpy as np
from hasel_tracker.live.live_tracker import LiveTracker
from hasel_tracker.sources.frame import Frame
from hasel_tracker.tracking.bending_tracker import BendingTracker, TrackedFrame

from hasel_tracker_lab.bench.accuracy import FRAME_RATE_HZ, renderer_for
from hasel_tracker_lab.bench.speed import CONDITION, JPEG_QUALITY

CAMERA_HZ = 60.0
DECODE_THREADS = 2


@dataclass(frozen=True)
class Latency:
    """Median and 95 % quantile [s] over the frames of a camera at 1080p; `dropped` of `frames` were not tracked."""

    median_s: float
    most_s: float
    frames: int
    dropped: int

    def __str__(self) -> str:
        return (
            f"{1e3 * self.median_s:.1f} ms from capture to angle (95 % within {1e3 * self.most_s:.1f} ms), "
            f"{self.dropped} of {self.frames} frames dropped at {CAMERA_HZ:.0f} frames/s of JPEG."
        )


def measure_latency(frames: int = 120) -> Latency:
    """Play rendered JPEG pictures as a camera to the live tracker; wall time, so the machine should be idle."""
    settings = [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY]
    pictures = [frame.image for frame in renderer_for(CONDITION).frames(FRAME_RATE_HZ, 24)]
    codes = [cv2.imencode(".jpg", picture, settings)[1].tobytes() for picture in pictures]
    back_and_forth = itertools.cycle(codes + codes[-2:0:-1])
    ended = threading.Event()
    late: list[float] = []
    begin, index = time.monotonic(), itertools.count()

    def read() -> Frame | None:
        number = next(index)
        if number == frames:
            ended.set()
            return None
        time.sleep(max(begin + number / CAMERA_HZ - time.monotonic(), 0.0))
        return Frame(number, number / CAMERA_HZ, jpeg=next(back_and_forth), stamp_ns=time.time_ns())

    def publish(frame: Frame, _: TrackedFrame) -> None:
        late.append((time.time_ns() - frame.stamp_ns) * 1e-9)

    live = LiveTracker(BendingTracker(), publish, decode_threads=DECODE_THREADS, read=read)
    live.start()
    ended.wait()
    live.stop()
    return Latency(float(np.median(late)), float(np.quantile(late, 0.95)), frames, live.queue.dropped)
