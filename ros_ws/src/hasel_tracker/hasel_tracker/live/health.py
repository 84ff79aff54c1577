"""How the live tracker is doing, second by second: fine, a warning, or an error, in one sentence each."""

import threading
from dataclasses import dataclass
from typing import Any

import numpy as np

from hasel_tracker.sources.camera_source import RATE_SHARE
from hasel_tracker.tracking.bending_tracker import TrackedFrame
from hasel_tracker.tracking.marker_set import marker_names

OK, WARN, ERROR = "OK", "WARN", "ERROR"  # as hasel_common.diagnostics.Level calls them
POSSIBLE_LATENCY_S = 10.0


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
