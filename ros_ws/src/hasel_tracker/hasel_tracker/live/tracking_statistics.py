"""How the live tracker is doing, second by second."""

import threading
from dataclasses import dataclass

import numpy as np

from hasel_tracker.tracking.bending_tracker import TrackedFrame


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
