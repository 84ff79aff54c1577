# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""All frames of a run, tracked; corrected by hand where a file says so; cut from the first movement on."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.frame import Frame
from hasel_tracker.tracking.bending_tracker import BendingTracker, TrackedFrame

EXAMPLE = "- {frame: 120, at: [[420, 540], [953, 540], [1529, 546]]}"
REST_FRAMES = 6
CLEAR_OF_NOISE = 6.0
LEAST_MOVEMENT = 0.002
MEDIAN_OF_SECOND_DIFFERENCES = 1.65  # of white noise with standard deviation one: 0.6745 · √6


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


def read_fixes(path: Path) -> dict[int, np.ndarray]:
    """Read a YAML list of frames (counted from 0) and positions (m, 2) [px], head first; raises TrackerError."""
    try:
        content = yaml.safe_load(Path(path).read_text())
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise TrackerError(f"The corrections {path} cannot be read: {str(error).splitlines()[0]}.") from error
    if not isinstance(content, list) or not content:
        raise TrackerError(
            f"The corrections {path} are not a list; write a line such as `{EXAMPLE}` for each frame."
        )
    return dict(_fix(path, entry) for entry in content)


def _fix(path: Path, entry: Any) -> tuple[int, np.ndarray]:
    try:
        frame, points = int(entry["frame"]), np.array(entry["at"], float)
        if frame < 0 or points.ndim != 2 or points.shape[1] != 2 or not np.isfinite(points).all():
            raise ValueError
    except (TypeError, KeyError, ValueError):
        raise TrackerError(
            f"The corrections {path} have the entry {entry}; expected a frame and its markers, such as `{EXAMPLE}`."
        ) from None
    return frame, points


def first_movement_s(time_s: np.ndarray, sin_theta: np.ndarray) -> float:
    """Time [s] of the last frame at rest before sin θ leaves its resting value for good.

    The resting value and its noise come from the first frames. Raises TrackerError if nothing ever moves,
    or if the body moves from the start.
    """
    seen = np.isfinite(sin_theta)
    time_s, sin_theta = time_s[seen], sin_theta[seen]
    if len(sin_theta) < 2 * REST_FRAMES:
        raise TrackerError(
            f"There are {len(sin_theta)} frames with an angle; expected at least {2 * REST_FRAMES} to "
            f"find the start."
        )
    rest = np.median(sin_theta[:REST_FRAMES])
    # Second differences: a body that moves steadily from the start is not taken for noise.
    noise = np.median(np.abs(np.diff(sin_theta[:REST_FRAMES], 2))) / MEDIAN_OF_SECOND_DIFFERENCES
    away = np.abs(sin_theta - rest) > max(CLEAR_OF_NOISE * noise, LEAST_MOVEMENT)
    lasting = away[:-1] & away[1:]
    if not lasting.any():
        raise TrackerError(
            f"sin θ never moves more than {np.abs(sin_theta - rest).max():.4f} from its start; "
            "check that the run was driven, or leave the cut out."
        )
    moved = int(np.argmax(lasting))
    if moved < REST_FRAMES - 1:
        raise TrackerError(
            f"The body moves within the first {REST_FRAMES} frames, so its start cannot be seen; "
            "begin recording before the drive, or leave the cut out."
        )
    return float(time_s[moved - 1])


def cut_to_periods(run: TrackedRun, frequency_hz: float, periods: float = 2.0) -> TrackedRun:
    """The run from the first movement on, for so many periods of the drive; its time starts at zero there."""
    if not (frequency_hz > 0.0 and periods > 0.0):
        raise TrackerError(
            f"Cannot cut to {periods} periods of {frequency_hz} Hz; expected positive numbers."
        )
    start = first_movement_s(run.time_s, run.sin_theta)
    end = start + periods / frequency_hz
    if end > run.time_s[-1] + 1.5 / run.frame_rate_hz:
        raise TrackerError(
            f"From the first movement at {start:.3f} s the run has {run.time_s[-1] - start:.3f} s, less than "
            f"{periods:g} periods of {frequency_hz:g} Hz ({periods / frequency_hz:.3f} s); cut to fewer "
            f"periods."
        )
    return run.between(start, end)
