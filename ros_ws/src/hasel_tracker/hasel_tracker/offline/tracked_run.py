"""All frames of a run, tracked."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.frame import Frame
from hasel_tracker.tracking.bending_tracker import BendingTracker, TrackedFrame


@dataclass(frozen=True)
class TrackedRun:
    """Time [s] (n,), sin θ and θ [rad] (n,), markers (n, 3, 2) [px] and quality (n, 3); NaN where lost.

    start_stamp_ns: time zero since the epoch [ns], or None if the source does not say.
    """

    time_s: np.ndarray
    sin_theta: np.ndarray
    theta: np.ndarray
    markers_px: np.ndarray
    quality: np.ndarray
    start_stamp_ns: int | None = None

    @property
    def valid(self) -> np.ndarray:
        """Which frames have an angle, shape (n,)."""
        return np.isfinite(self.sin_theta)

    @property
    def frame_rate_hz(self) -> float:
        """Median frame rate [1/s]; NaN for fewer than two frames."""
        return float(1.0 / np.median(np.diff(self.time_s))) if len(self.time_s) > 1 else float("nan")

    def between(self, start_s: float, end_s: float) -> "TrackedRun":
        """The frames from `start_s` up to, not including, `end_s`; times stay as they are."""
        kept = (self.time_s >= start_s - 1e-9) & (self.time_s < end_s - 1e-9)
        return TrackedRun(
            self.time_s[kept],
            self.sin_theta[kept],
            self.theta[kept],
            self.markers_px[kept],
            self.quality[kept],
            self.start_stamp_ns,
        )

    def __str__(self) -> str:
        lost = int((~self.valid).sum())
        text = f"{len(self.time_s)} frames at {self.frame_rate_hz:.4g} frames/s"
        if lost == len(self.time_s):
            return f"{text}, an angle in none of them."
        low, high = np.nanmin(self.sin_theta), np.nanmax(self.sin_theta)
        return f"{text}, {lost} without an angle; sin θ from {low:+.4f} to {high:+.4f}."


def track_frames(
    frames: Iterable[Frame],
    tracker: BendingTracker,
    seen: Callable[[Frame, TrackedFrame], None] | None = None,
    start_stamp_ns: int | None = None,
) -> TrackedRun:
    """Track every frame; `seen` is told of each (for progress and annotated video)."""
    tracked: list[TrackedFrame] = []
    for frame in frames:
        frame = frame.decoded()
        tracked.append(tracker.update(frame.image, frame.time_s))
        if seen is not None:
            seen(frame, tracked[-1])
    if not tracked:
        raise TrackerError("The source has no frames; check that the video or folder is the right one.")
    return TrackedRun(
        np.array([each.time_s for each in tracked]),
        np.array([each.sin_theta for each in tracked]),
        np.array([each.theta for each in tracked]),
        np.array([each.markers.positions for each in tracked]),
        np.array([each.markers.quality for each in tracked]),
        start_stamp_ns,
    )
