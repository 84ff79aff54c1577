# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Frames per second on one core, and the time from a frame's capture to its angle."""

import itertools
import threading
import time
from dataclasses import dataclass

import cv2
import numpy as np
from hasel_tracker.live_tracker import LiveTracker
from hasel_tracker.sources.frame import Frame
from hasel_tracker.tracking import DEFAULT_METHOD
from hasel_tracker.tracking.bending_tracker import BendingTracker, TrackedFrame
from hasel_tracker.tracking.doubt import AGREEING_FRAMES

from hasel_tracker_lab.bench.accuracy import CONDITIONS, FRAME_RATE_HZ, image_of, renderer_for
from hasel_tracker_lab.scenes.lab_scene import LabScene
from hasel_tracker_lab.scenes.lab_swimmer import DARK, LabSwimmer

JPEG_QUALITY = 75
CONDITION = CONDITIONS[2]
CAMERA_HZ = 60.0
DECODE_THREADS = 2


@dataclass(frozen=True)
class TrackerSpeed:
    """Median frames per second of one core's time at 1080p: tracking alone, and with JPEG decoding before."""

    tracking_hz: float
    with_decoding_hz: float
    csrt_hz: float
    midline_hz: float

    def __str__(self) -> str:
        return (
            f"{self.tracking_hz:.0f} frames/s without decoding, {self.with_decoding_hz:.0f} frames/s with "
            f"JPEG "
            f"decoding; CSRT {self.csrt_hz:.1f} frames/s ({self.tracking_hz / self.csrt_hz:.0f} times "
            f"slower), midline {self.midline_hz:.1f} frames/s."
        )


def measure_speed(frames: int = 24, repeats: int = 8, csrt_frames: int = 8) -> TrackerSpeed:
    """Time the trackers on rendered pictures held in memory, OpenCV limited to one thread."""
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        pictures = [frame.image for frame in renderer_for(CONDITION).frames(FRAME_RATE_HZ, frames)]
        settings = [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY]
        encoded = [cv2.imencode(".jpg", picture, settings)[1].tobytes() for picture in pictures]
        plain = [Frame(i, i / FRAME_RATE_HZ, image=picture) for i, picture in enumerate(pictures)]
        coded = [Frame(i, i / FRAME_RATE_HZ, jpeg=code) for i, code in enumerate(encoded)]
        return TrackerSpeed(
            _rate(plain, DEFAULT_METHOD, repeats),
            _rate(coded, DEFAULT_METHOD, repeats),
            _rate(plain[: csrt_frames + 1], "csrt", 1),
            _rate(_bare_frames(csrt_frames), "midline", 1),
        )
    finally:
        cv2.setNumThreads(threads)


def _bare_frames(count: int) -> list[Frame]:
    """A swimmer without dots at 1080p, its body 1000 px long."""
    swimmer = LabSwimmer(1000.0, (460.0, 540.0), marked=False, body_colour=DARK, half_width_px=50.0)
    scene = LabScene((swimmer,), size_px=(1920, 1080), exposure_s=0.0)
    return [Frame(i, each.time_s, image=each.image) for i, each in enumerate(scene.frames(count))]


def _rate(frames: list[Frame], method: str, repeats: int) -> float:
    """Median frames per second of processor time; back and forth, so that no frame is far from the last."""
    tracker = BendingTracker(method=method)
    step_s = 1.0 / FRAME_RATE_HZ
    for number in range(AGREEING_FRAMES + 1):
        tracker.update(image_of(frames[0]), (number - AGREEING_FRAMES) * step_s)
    times = []
    order = (frames[1:] + frames[-2::-1]) * repeats if repeats > 1 else frames[1:]
    for number, frame in enumerate(order, start=1):
        start = time.thread_time()
        tracked = tracker.update(image_of(frame), number * step_s)
        times.append(time.thread_time() - start)
        if not tracked.valid:
            break
    return 1.0 / float(np.median(times))


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
        if frame.stamp_ns is not None:
            late.append((time.time_ns() - frame.stamp_ns) * 1e-9)

    live = LiveTracker(BendingTracker(), publish, decode_threads=DECODE_THREADS, read=read)
    live.start()
    ended.wait()
    live.stop()
    return Latency(float(np.median(late)), float(np.quantile(late, 0.95)), frames, live.queue.dropped)
