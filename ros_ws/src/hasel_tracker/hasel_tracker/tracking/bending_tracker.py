"""From images to the bending angle: a marker tracker, the calibration of its three points, and the angle."""

from dataclasses import dataclass

import numpy as np

from hasel_tracker.calibration.camera_calibration import CameraCalibration
from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.bending_angle import bending_angle
from hasel_tracker.tracking.csrt_tracker import CsrtTracker
from hasel_tracker.tracking.marker_set import MARKER_NAMES, MarkerSet
from hasel_tracker.tracking.moment_tracker import MomentTracker
from hasel_tracker.tracking.tracker_settings import METHODS, TrackerSettings


@dataclass(frozen=True)
class TrackedFrame:
    """What one frame says: its time [s], the markers [px], sin θ and θ [rad] (NaN unless `valid`)."""

    time_s: float
    markers: MarkerSet
    sin_theta: float
    theta: float

    @property
    def valid(self) -> bool:
        """Whether all three markers were found in this very frame."""
        return bool(np.isfinite(self.sin_theta))

    def __str__(self) -> str:
        if self.valid:
            return f"At {self.time_s:.4f} s sin θ is {self.sin_theta:+.5f}: {self.markers}."
        lost = [name for name, found in zip(MARKER_NAMES, self.markers.found, strict=True) if not found]
        return f"At {self.time_s:.4f} s there is no angle: {' and '.join(lost)} lost."


class BendingTracker:
    """Tracks with a method (`moment` or `csrt`) and turns positions into the angle."""

    def __init__(
        self,
        settings: TrackerSettings = TrackerSettings(),  # noqa: B008
        method: str = "moment",
        calibration: CameraCalibration | None = None,
        mirrored: bool = False,
        boxes: list[tuple[int, int, int, int]] | None = None,
    ) -> None:
        if method not in METHODS:
            raise TrackerError(f"The tracking method is '{method}'; expected {' or '.join(METHODS)}.")
        self.calibration = calibration
        self.mirrored = mirrored
        self._markers = MomentTracker(settings) if method == "moment" else CsrtTracker(settings, boxes)

    @property
    def note(self) -> str:
        """How the markers were found and ordered, or why they were not."""
        return self._markers.note

    def update(self, image: np.ndarray, time_s: float) -> TrackedFrame:
        """Track one 8-bit BGR image, shape (height, width, 3), taken at `time_s`."""
        if image.ndim != 3 or image.shape[2] != 3 or image.dtype != np.uint8:
            raise TrackerError(
                f"Found an image of shape {image.shape} and type {image.dtype}; expected 8-bit colour in "
                f"BGR order."
            )
        markers = self._markers.update(image, time_s)
        points = markers.positions
        if self.calibration is not None:
            points = self.calibration.to_plane(points, image.shape[1::-1])
        sin_theta, theta = bending_angle(points, self.mirrored)
        return TrackedFrame(time_s, markers, sin_theta, theta)
