# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""From images to the bending angle: a marker tracker, the calibration of its points, and the angle."""

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from hasel_tracker.calibration.camera_calibration import CameraCalibration
from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking import DEFAULT_METHOD, METHODS
from hasel_tracker.tracking.apriltag_tracker import AprilTagTracker
from hasel_tracker.tracking.csrt_tracker import CsrtTracker
from hasel_tracker.tracking.doubt import Doubt
from hasel_tracker.tracking.marker_contour import measure_contour
from hasel_tracker.tracking.marker_moment import measure_marker
from hasel_tracker.tracking.marker_set import MarkerSet, bending_angle
from hasel_tracker.tracking.marker_tracker import MarkerTracker
from hasel_tracker.tracking.midline_tracker import MidlineTracker
from hasel_tracker.tracking.tracker_settings import TrackerSettings

SMALL_STEP_PX = 0.5


class _Method(Protocol):
    note: str

    def update(self, image: np.ndarray, time_s: float) -> MarkerSet: ...


@dataclass(frozen=True)
class TrackedFrame:
    """What one frame says: its time [s], the markers [px], sin θ and θ [rad] (NaN unless `valid`).

    sin_theta_std: standard deviation of sin θ that the picture's noise explains. positions_m: the markers (m, 2) in
    the swimming plane [m], y up, or None without a calibration. held: sin θ and θ of a frame in doubt, in case a later
    one vouches for it.
    """

    time_s: float
    markers: MarkerSet
    sin_theta: float
    theta: float
    sin_theta_std: float = float("nan")
    positions_m: np.ndarray | None = None
    held: tuple[float, float] = (float("nan"), float("nan"))

    @property
    def valid(self) -> bool:
        """Whether all markers were found in this very frame, and without doubt."""
        return bool(np.isfinite(self.sin_theta))

    def believed(self) -> "TrackedFrame":
        """The same frame after a later one has vouched for it."""
        sin_theta, theta = self.held
        return replace(
            self, sin_theta=sin_theta, theta=theta, markers=replace(self.markers, doubt=Doubt.NONE)
        )

    def __str__(self) -> str:
        if self.valid:
            return f"At {self.time_s:.4f} s sin θ is {self.sin_theta:+.5f}: {self.markers}."
        lost = [name for name, found in zip(self.markers.names, self.markers.found, strict=True) if not found]
        why = f"{' and '.join(lost)} lost" if lost else str(self.markers.doubt)
        return f"At {self.time_s:.4f} s there is no angle: {why}."


class BendingTracker:
    """Tracks with a method and turns positions into the angle.

    roi: (x, y, width, height) [px] outside of which nothing is looked at. start_at: (m, 2) [px], where a person says
    that the markers are in the first image.
    """

    def __init__(
        self,
        settings: TrackerSettings = TrackerSettings(),  # noqa: B008
        method: str = DEFAULT_METHOD,
        calibration: CameraCalibration | None = None,
        mirrored: bool = False,
        boxes: list[tuple[int, int, int, int]] | None = None,
        roi: tuple[int, int, int, int] | None = None,
        start_at: np.ndarray | None = None,
    ) -> None:
        if method not in METHODS:
            raise TrackerError(f"The tracking method is '{method}'; expected one of {', '.join(METHODS)}.")
        self.settings = settings
        self.calibration = calibration
        self.mirrored = mirrored
        self.roi = roi
        self._start_at = start_at
        self._markers = _method(method, settings, boxes)

    @property
    def note(self) -> str:
        """How the markers were found and ordered, or why they were not."""
        return self._markers.note

    def update(self, image: np.ndarray, time_s: float, at: np.ndarray | None = None) -> TrackedFrame:
        """Track one 8-bit BGR image, shape (height, width, 3), taken at `time_s`.

        at: (m, 2) [px], where a person says that the markers are in this image, head first; None to find them.
        """
        if image.ndim != 3 or image.shape[2] != 3 or image.dtype != np.uint8:
            raise TrackerError(
                f"Found an image of shape {image.shape} and type {image.dtype}; expected 8-bit colour in "
                f"BGR order."
            )
        view, corner = within(image, self.roi)
        at, self._start_at = self._start_at if at is None else at, None
        if at is None:
            markers = self._markers.update(view, time_s)
        elif isinstance(self._markers, MarkerTracker):
            markers = self._markers.place(view, np.asarray(at, float) - corner, time_s)
        else:
            raise TrackerError(
                "Markers can be pointed at only with the methods contour and moment; use one of them."
            )
        markers = replace(markers, positions=markers.positions + corner)
        return self._angle(markers, time_s, image.shape[1::-1])

    def _angle(self, markers: MarkerSet, time_s: float, size_px: tuple[int, int]) -> TrackedFrame:
        points, slopes = markers.positions, None
        positions_m = None
        if self.calibration is not None:
            count = len(points)
            beside = np.vstack([points, points + [SMALL_STEP_PX, 0.0], points + [0.0, SMALL_STEP_PX]])
            plane = self.calibration.to_plane(beside, size_px)
            points = plane[:count]
            slopes = (plane[count:].reshape(2, count, 2) - points) / SMALL_STEP_PX
            positions_m = points * [1.0, 1.0 if self.mirrored else -1.0]
        angle = bending_angle(points, self.mirrored, self.settings.rest_direction_deg)
        std = self._standard_deviation(points, markers.sigma_px, slopes)
        seen = markers.doubt is Doubt.NONE
        shown = angle if seen else (float("nan"), float("nan"))
        return TrackedFrame(time_s, markers, *shown, std, positions_m, angle)

    def _standard_deviation(
        self, points: np.ndarray, sigma_px: np.ndarray, slopes: np.ndarray | None
    ) -> float:
        """Standard deviation of sin θ from that of the markers [px]; slopes: (2, m, 2) of the plane per pixel."""
        if not np.isfinite(points).all():
            return float("nan")
        slopes = np.broadcast_to(np.eye(2)[:, None], (2, len(points), 2)) if slopes is None else slopes
        base, variance = bending_angle(points, False, self.settings.rest_direction_deg)[0], 0.0
        inner = {0, (len(points) - 1) // 2, len(points) // 2, len(points) - 1}
        for number in sorted(inner):
            for axis in (0, 1):
                moved = points.copy()
                moved[number] += 1e-3 * slopes[axis, number]
                change = bending_angle(moved, False, self.settings.rest_direction_deg)[0] - base
                variance += (1e3 * change * sigma_px[number]) ** 2
        return float(np.sqrt(variance))


def _method(method: str, settings: TrackerSettings, boxes: list[tuple[int, int, int, int]] | None) -> _Method:
    if method == "apriltag":
        return AprilTagTracker(settings)
    if method == "midline":
        return MidlineTracker(settings)
    if method == "csrt":
        return CsrtTracker(settings, boxes)
    return MarkerTracker(settings, measure_marker if method == "moment" else measure_contour)


def within(image: np.ndarray, roi: tuple[int, int, int, int] | None) -> tuple[np.ndarray, np.ndarray]:
    """The part of the image within the region, and its corner (2,) [px]."""
    if roi is None:
        return image, np.zeros(2)
    x, y, width, height = roi
    part = image[y : y + height, x : x + width]
    if min(roi) < 0 or part.shape[:2] != (height, width) or min(width, height) < 16:
        raise TrackerError(
            f"The region {x},{y},{width},{height} is not within the image of {image.shape[1]} × {image.shape[0]} px; "
            "give x, y, width and height of a part of it."
        )
    return part, np.array([x, y], float)
