# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Capture, decode and track in threads; hand every tracked frame on as soon as it is ready; say how that goes."""

import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.camera_source import RATE_SHARE, CaptureThread
from hasel_tracker.sources.frame import DropOldestQueue, Frame, decoded_in_order
from hasel_tracker.tracking.bending_tracker import BendingTracker, TrackedFrame
from hasel_tracker.tracking.marker_set import marker_names
from hasel_tracker.video.video_writer import VideoRecorder

IDLE_S = 0.2
OK, WARN, ERROR = "OK", "WARN", "ERROR"  # as hasel_common.diagnostics.Level calls them
POSSIBLE_LATENCY_S = 10.0


class LiveTracker:
    """Runs `tracker` on the frames of `queue`, which `read` (if given) fills from a thread of its own.

    `publish` is called in the tracking thread with each frame and what was found in it. `stop` ends the
    threads.
    """

    def __init__(
        self,
        tracker: BendingTracker,
        publish: Callable[[Frame, TrackedFrame], None],
        queue_size: int = 8,
        decode_threads: int = 2,
        read: Callable[[], Frame | None] | None = None,
    ) -> None:
        self.tracker = tracker
        self.queue: DropOldestQueue[Frame] = DropOldestQueue(queue_size)
        self.statistics = TrackingStatistics()
        self.fault = ""
        self.broken_frames = 0
        self._publish = publish
        self._decode_threads = decode_threads
        self._capture = None if read is None else CaptureThread(read, self.queue)
        self._thread = threading.Thread(target=self._run, name="tracking", daemon=True)
        self._recorder: VideoRecorder | None = None
        self._recorder_lock = threading.Lock()

    def start(self) -> None:
        """Begin to capture and track."""
        self._thread.start()
        if self._capture is not None:
            self._capture.start()

    def stop(self) -> None:
        """Stop capturing, track what is queued, finish a video being recorded."""
        if self._capture is not None:
            self._capture.stop()
        self.queue.close()
        if self._thread.is_alive():
            self._thread.join(timeout=5.0)
        if self.recording is not None:
            self.record_until_now()

    @property
    def running(self) -> bool:
        """Whether frames may still come."""
        return self._thread.is_alive()

    @property
    def recording(self) -> VideoRecorder | None:
        """The video being recorded, or None."""
        return self._recorder

    def record(self, recorder: VideoRecorder) -> None:
        """Write the frames from now on; raises TrackerError if a video is being recorded already."""
        with self._recorder_lock:
            if self._recorder is not None:
                raise TrackerError(f"{self._recorder.path} is being recorded already; stop that video first.")
            self._recorder = recorder

    def record_until_now(self) -> str:
        """Finish the video being recorded and say what is in it; raises TrackerError if there is none."""
        with self._recorder_lock:
            recorder, self._recorder = self._recorder, None
        if recorder is None:
            raise TrackerError("No video is being recorded; start one first.")
        return recorder.close()

    def _run(self) -> None:
        for frame in decoded_in_order(self._arriving(), self._decode_threads, self._note_broken):
            with self._recorder_lock:
                if self._recorder is not None:
                    self._recorder.add(frame)
            try:
                tracked = self.tracker.update(frame.image, frame.time_s)
            except TrackerError as error:
                self.fault = str(error)
                continue
            self._publish(frame, tracked)
            self.statistics.add(tracked, frame.stamp_ns, time.time_ns())

    def _arriving(self) -> Iterator[Frame | None]:
        while not (self.queue.closed and len(self.queue) == 0):
            yield self.queue.get(IDLE_S)

    def _note_broken(self, error: TrackerError) -> None:
        self.broken_frames += 1
        self.fault = str(error)


@dataclass(frozen=True)
class Health:
    """One interval: frame rate [1/s], latency from capture to angle [s], share lost.

    quality: mean of each marker, (m,); empty when no frame arrived.
    """

    frames: int
    frame_rate_hz: float
    mean_latency_s: float
    worst_latency_s: float
    quality: np.ndarray
    lost_share: float

    def __str__(self) -> str:
        if self.frames == 0:
            return "No frame arrived."
        return (
            f"{self.frame_rate_hz:.1f} frames/s, latency {1e3 * self.mean_latency_s:.1f} ms (worst "
            f"{1e3 * self.worst_latency_s:.1f} ms), {100 * self.lost_share:.0f} % of frames without an angle."
        )


class TrackingStatistics:
    """Collects frames from the tracking thread; `take` gives the figures since the last call."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._clear()

    def add(self, tracked: TrackedFrame, stamp_ns: int, done_ns: int) -> None:
        """Note a frame captured at `stamp_ns` whose angle was ready at `done_ns`."""
        with self._lock:
            self._stamps.append(stamp_ns)
            self._latencies.append((done_ns - stamp_ns) * 1e-9)
            self._qualities.append(tracked.markers.quality)
            self._lost += not tracked.valid

    def take(self) -> Health:
        """Figures of the frames since the last call."""
        with self._lock:
            frames = len(self._stamps)
            if frames == 0:
                nothing = float("nan")
                return Health(0, 0.0, nothing, nothing, np.zeros(0), nothing)
            span_s = (self._stamps[-1] - self._stamps[0]) * 1e-9
            health = Health(
                frames,
                (frames - 1) / span_s if span_s > 0.0 else 0.0,
                float(np.mean(self._latencies)),
                float(np.max(self._latencies)),
                np.mean(self._qualities, axis=0),
                self._lost / frames,
            )
            self._clear()
        return health

    def _clear(self) -> None:
        self._stamps: list[int] = []
        self._latencies: list[float] = []
        self._qualities: list[np.ndarray] = []
        self._lost = 0


@dataclass(frozen=True)
class HealthReport:
    """Level by its name, and what to know."""

    level: str
    message: str


def judge(
    health: Health, asked_rate_hz: float | None, newly_dropped: int, complaint: str, fault: str
) -> HealthReport:
    """The worst first: no frames, a fault, a slow camera, dropped frames, lost markers, another format."""
    if health.frames == 0:
        return HealthReport(ERROR, fault or "No frame arrived; check the camera or the image topic.")
    if not -POSSIBLE_LATENCY_S < health.mean_latency_s < POSSIBLE_LATENCY_S:
        return HealthReport(
            ERROR,
            fault
            or f"Frames are stamped {health.mean_latency_s:.4g} s before their angle is known, which cannot be: set "
            "the camera's clock.",
        )
    warnings = [fault] if fault else []
    if asked_rate_hz is not None and health.frame_rate_hz < RATE_SHARE * asked_rate_hz:
        warnings.append(
            f"The camera gives {health.frame_rate_hz:.1f} frames/s of {asked_rate_hz:g}; "
            "shorten the exposure or ask for a smaller picture."
        )
    if newly_dropped:
        warnings.append(f"{newly_dropped} frames were dropped; the computer is too slow or busy.")
    if health.lost_share > 0.0:
        warnings.append(f"{100 * health.lost_share:.0f} % of the frames had no angle: a marker was lost.")
    if complaint:
        warnings.append(complaint)
    return HealthReport(WARN, " ".join(warnings)) if warnings else HealthReport(OK, str(health))


def health_values(health: Health) -> dict[str, Any]:
    """What `/diagnostics` says of the frames since it was last asked."""
    names = marker_names(len(health.quality)) if health.frames else ()
    return {
        "frame rate [1/s]": f"{health.frame_rate_hz:.2f}",
        "mean latency [ms]": f"{1e3 * health.mean_latency_s:.2f}",
        "worst latency [ms]": f"{1e3 * health.worst_latency_s:.2f}",
        "frames without angle": f"{health.lost_share:.3f}",
        **{f"quality of {name}": f"{value:.2f}" for name, value in zip(names, health.quality, strict=True)},
    }
