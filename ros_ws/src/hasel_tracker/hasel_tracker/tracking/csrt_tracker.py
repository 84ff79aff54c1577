# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The seed paper's method, for comparison: one OpenCV CSRT tracker per marker, its box's centre; it never doubts."""

import cv2
import numpy as np

from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.marker_moment import measure_marker
from hasel_tracker.tracking.marker_set import MarkerSet
from hasel_tracker.tracking.marker_tracker import MarkerTracker
from hasel_tracker.tracking.tracker_settings import TrackerSettings

BOX_RADII = 1.6


class CsrtTracker:
    """Follows boxes around head, middle and tail; boxes (x, y, width, height) [px] are given or found."""

    def __init__(
        self,
        settings: TrackerSettings = TrackerSettings(),  # noqa: B008
        boxes: list[tuple[int, int, int, int]] | None = None,
    ) -> None:
        if not hasattr(cv2, "TrackerCSRT_create"):
            raise TrackerError(
                f"OpenCV {cv2.__version__} has no CSRT tracker; expected the contrib build. "
                "Install opencv-contrib-python-headless instead of opencv-python."
            )
        if boxes is not None and len(boxes) != settings.marker_count:
            raise TrackerError(
                f"Found {len(boxes)} boxes for CSRT; expected {settings.marker_count}, from head to tail."
            )
        self.settings = settings
        self.note = "boxes as given"
        self._count = settings.marker_count
        self._boxes = boxes
        self._trackers: list[cv2.TrackerCSRT] = []

    def update(self, image: np.ndarray, time_s: float) -> MarkerSet:
        """Box centres in an 8-bit BGR image; quality is 1 where CSRT says it has the marker."""
        if not self._trackers:
            return self._start(image, time_s)
        positions, quality = np.full((self._count, 2), np.nan), np.zeros(self._count)
        for number, tracker in enumerate(self._trackers):
            followed, box = tracker.update(image)
            if followed:
                positions[number], quality[number] = _centre(box), 1.0
        return MarkerSet(positions, quality, np.full(self._count, np.nan))

    def _start(self, image: np.ndarray, time_s: float) -> MarkerSet:
        boxes = self._boxes or self._found_boxes(image, time_s)
        if boxes is None:
            return MarkerSet.lost(self._count)
        for box in boxes:
            tracker = cv2.TrackerCSRT_create()  # type: ignore[attr-defined]
            tracker.init(image, box)
            self._trackers.append(tracker)
        return MarkerSet(
            np.array([_centre(box) for box in boxes]), np.ones(self._count), np.full(self._count, np.nan)
        )

    def _found_boxes(self, image: np.ndarray, time_s: float) -> list[tuple[int, int, int, int]] | None:
        finder = MarkerTracker(self.settings, measure_marker)
        markers = finder.update(image, time_s)
        self.note = finder.note
        if not markers.found.all():
            return None
        reach = BOX_RADII * finder.radius_px
        corners = np.rint(markers.positions - reach).astype(int)
        size = round(2 * reach)
        return [(int(x), int(y), size, size) for x, y in corners]


def _centre(box: tuple[float, float, float, float]) -> np.ndarray:
    x, y, width, height = box
    return np.array([x + 0.5 * (width - 1), y + 0.5 * (height - 1)])
