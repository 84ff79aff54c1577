"""All frames of a run, tracked."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields, replace

import numpy as np

from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.frame import Frame
from hasel_tracker.tracking.bending_tracker import BendingTracker, TrackedFrame


@dataclass(frozen=True)
class TrackedRun:
    """Time [s] (n,), sin θ and θ [rad] (n,), markers (n, m, 2) [px] and quality (n, m); NaN where lost.

    sin_theta_std: (n,) what the picture's noise explains. doubt: (n,) numbers of Doubt. markers_m: (n, m, 2) [m], y up,
    or None without a calibration. start_stamp_ns: time zero since the epoch [ns], or None if the source does not say.
    """

    time_s: np.ndarray
    sin_theta: np.ndarray
    theta: np.ndarray
    markers_px: np.ndarray
    quality: np.ndarray
    start_stamp_ns: int | None = None
    sin_theta_std: np.ndarray | None = None
    doubt: np.ndarray | None = None
    markers_m: np.ndarray | None = None

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
        arrays = {
            each.name: getattr(self, each.name)[kept]
            for each in fields(self)
            if isinstance(getattr(self, each.name), np.ndarray)
        }
        return replace(self, **arrays)

    def __str__(self) -> str:
        lost = int((~self.valid).sum())
        text = f"{len(self.time_s)} frames at {self.frame_rate_hz:.4g} frames/s"
        if len(self.time_s) < 2:
            text = "1 frame"
        if lost == len(self.time_s):
            return f"{text}, an angle in none of them."
        low, high = np.nanmin(self.sin_theta), np.nanmax(self.sin_theta)
        doubtful = 0 if self.doubt is None else int((self.doubt > 0).sum())
        why = f" ({doubtful} in doubt)" if doubtful else ""
        return f"{text}, {lost} without an angle{why}; sin θ from {low:+.4f} to {high:+.4f}."


def track_frames(
    frames: Iterable[Frame],
    tracker: BendingTracker,
    seen: Callable[[Frame, TrackedFrame], None] | None = None,
    start_stamp_ns: int | None = None,
    placed: Mapping[int, np.ndarray] | None = None,
) -> TrackedRun:
    """Track every frame; `seen` is told of each (for progress and annotated video).

    Frames held back in doubt count once a later one vouches for them. placed: frame number → where a person says that
    the markers are, (m, 2) [px]. Raises TrackerError when a frame named there is not in the video.
    """
    tracked: list[TrackedFrame] = []
    placed = dict(placed or {})
    for frame in frames:
        frame = frame.decoded()
        tracked.append(tracker.update(frame.image, frame.time_s, placed.pop(frame.index, None)))
        for number in range(len(tracked) - 1 - tracked[-1].markers.vouches_for, len(tracked) - 1):
            tracked[number] = tracked[number].believed()
        if seen is not None:
            seen(frame, tracked[-1])
    if placed:
        raise TrackerError(
            f"Positions are given for frame {min(placed)}, but the source has {len(tracked)} frames, counted from 0."
        )
    if not tracked:
        raise TrackerError("The source has no frames; check that the video or folder is the right one.")
    return TrackedRun(
        np.array([each.time_s for each in tracked]),
        np.array([each.sin_theta for each in tracked]),
        np.array([each.theta for each in tracked]),
        np.array([each.markers.positions for each in tracked]),
        np.array([each.markers.quality for each in tracked]),
        start_stamp_ns,
        np.array([each.sin_theta_std for each in tracked]),
        np.array([int(each.markers.doubt) for each in tracked]),
        None if tracked[0].positions_m is None else np.array([each.positions_m for each in tracked]),
    )
