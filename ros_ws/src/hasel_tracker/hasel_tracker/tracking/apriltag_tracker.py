"""AprilTags instead of dots: each tag says which marker it is, so nothing can be swapped or mistaken."""

import cv2
import numpy as np

from hasel_tracker.tracking.doubt import Doubt
from hasel_tracker.tracking.marker_set import MarkerSet
from hasel_tracker.tracking.tag_border import border_corners
from hasel_tracker.tracking.tracker_settings import TrackerSettings

REGION_SIDES = 3.0


class AprilTagTracker:
    """Finds the tags 0 (head) to m − 1 (tail) of the family 36h11; a marker is where a tag's diagonals cross."""

    def __init__(self, settings: TrackerSettings = TrackerSettings()) -> None:  # noqa: B008
        self.note = f"tags 0 to {settings.marker_count - 1} of the family 36h11, from head to tail"
        self._count = settings.marker_count
        parameters = cv2.aruco.DetectorParameters()
        parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_CONTOUR
        dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)
        self._detector = cv2.aruco.ArucoDetector(dictionary, parameters)
        self._last: dict[int, np.ndarray] = {}

    def update(self, image: np.ndarray, time_s: float) -> MarkerSet:
        """Tags in an 8-bit BGR image: near where each was in the last frame, or else anywhere."""
        grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
        seen: dict[int, np.ndarray] = {}
        doubt = Doubt.NONE
        for number, corners in self._last.items():
            seen |= {tag: each for tag, each in self._near(grey, corners) if tag == number}
        if len(seen) < self._count:
            found = self._tags(grey)
            tags = [tag for tag, _ in found if tag < self._count]
            if len(tags) > len(set(tags)):
                doubt = Doubt.AMBIGUOUS
                self.note = "a tag is in view twice; cover the other one"
            seen = {tag: corners for tag, corners in found if tag < self._count}
        self._last = seen if doubt is Doubt.NONE else {}
        positions, sigma = np.full((self._count, 2), np.nan), np.full(self._count, np.nan)
        for tag, corners in seen.items():
            fine, sigma[tag] = border_corners(grey, corners)
            positions[tag] = _crossing(fine)
        return MarkerSet(positions, np.isfinite(sigma).astype(float), sigma, doubt)

    def _near(self, grey: np.ndarray, corners: np.ndarray) -> list[tuple[int, np.ndarray]]:
        middle, side = corners.mean(axis=0), np.linalg.norm(corners[1] - corners[0])
        left, top = np.maximum(np.rint(middle - 0.5 * REGION_SIDES * side).astype(int), 0)
        size = int(REGION_SIDES * side) + 1
        region = grey[top : top + size, left : left + size]
        return [(tag, each + (left, top)) for tag, each in self._tags(region)]

    def _tags(self, grey: np.ndarray) -> list[tuple[int, np.ndarray]]:
        corners, tags, _ = self._detector.detectMarkers(grey)
        return (
            []
            if tags is None
            else [(int(t), c[0].astype(float)) for t, c in zip(tags.ravel(), corners, strict=True)]
        )


def _crossing(corners: np.ndarray) -> np.ndarray:
    """Where the diagonals of a quadrilateral (4, 2) cross: the tag's middle, in perspective too."""
    first, second = corners[2] - corners[0], corners[3] - corners[1]
    share = np.linalg.solve(np.column_stack([first, -second]), corners[1] - corners[0])
    return corners[0] + share[0] * first
