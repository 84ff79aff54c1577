# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""AprilTags instead of dots: each tag says which marker it is, so nothing can be swapped or mistaken.

A tag's corners are those of its black border: a straight line through the half-level edge of each side.
"""

from dataclasses import dataclass

import cv2
import numpy as np

from hasel_tracker.tracking.doubt import Doubt
from hasel_tracker.tracking.marker_set import MarkerSet
from hasel_tracker.tracking.tracker_settings import TrackerSettings

REGION_SIDES = 3.0
POINTS = 32
STEP_PX = 0.25
BORDER_CELLS = 8  # black border included; the border is one cell wide, and so is the white rim
LEAST_POINTS = 8
REWEIGHTINGS = 4
CORRELATED_PX = 2.0
ROUGH_SHARE = 0.01


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


@dataclass(frozen=True)
class _Side:
    """A line: a point on it (2,), its direction (2,), and the standard deviation of its place [px]."""

    point: np.ndarray
    along: np.ndarray
    sigma_px: float


def border_corners(grey: np.ndarray, corners: np.ndarray) -> tuple[np.ndarray, float]:
    """Corners (4, 2) [px] of a tag in an 8-bit grey image, from rough ones in clockwise order, and the standard
    deviation of their mean, each way [px]; the rough ones where a side is not clear."""
    sides = [_side(grey, corners[n], corners[(n + 1) % 4]) for n in range(4)]
    if all(sides):
        found = np.array([_meeting(sides[n - 1], sides[n]) for n in range(4)])
        if np.linalg.norm(found - corners, axis=1).max() < _length(corners) / BORDER_CELLS:
            # Two opposite sides fix each direction.
            return found, float(np.sqrt(np.mean([side.sigma_px**2 for side in sides]) / 2.0))
    return corners, ROUGH_SHARE * _length(corners)


def _length(corners: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(corners, axis=0, append=corners[:1]), axis=1).mean())


def _side(grey: np.ndarray, first: np.ndarray, last: np.ndarray) -> _Side | None:
    """The side between two rough corners (2,), or None where too little of the edge is seen."""
    length = float(np.linalg.norm(last - first))
    along = (last - first) / length
    across = np.array([along[1], -along[0]])  # outwards, as corners go clockwise in the picture
    share = np.linspace(0.1, 0.9, POINTS)[:, None]
    reach = 0.6 * length / BORDER_CELLS
    offset = np.arange(-reach, reach + 1e-9, STEP_PX)
    points = first + share[..., None] * length * along + offset[None, :, None] * across
    levels = cv2.remap(
        grey, points[..., 0].astype(np.float32), points[..., 1].astype(np.float32), cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
    ).astype(float)  # fmt: skip
    half = 0.5 * (levels.min(axis=1) + levels.max(axis=1))
    above = levels - half[:, None]
    rises = (above[:, :-1] < 0.0) & (above[:, 1:] >= 0.0)
    clear = (rises.sum(axis=1) == 1) & (np.ptp(levels, axis=1) > 0.5 * np.median(np.ptp(levels, axis=1)))
    if clear.sum() < LEAST_POINTS:
        return None
    rows = np.flatnonzero(clear)
    column = rises[rows].argmax(axis=1)
    before, after = above[rows, column], above[rows, column + 1]
    edge = offset[column] + STEP_PX * before / (before - after)
    place = share[rows, 0] * length
    slope, level, spread = _line(place, edge)
    independent = 0.8 * clear.mean() * length / CORRELATED_PX
    return _Side(first + level * across, along + slope * across, spread / np.sqrt(max(independent, 1.0)))


def _line(place: np.ndarray, edge: np.ndarray) -> tuple[float, float, float]:
    """Slope, level and scatter of a line, robust against stretches where something lies over the edge."""
    weight = np.ones(len(place))
    for _ in range(REWEIGHTINGS):
        slope, level = np.polyfit(place, edge, 1, w=weight)
        left = np.abs(edge - level - slope * place)
        spread = 1.48 * np.median(left) + 0.02
        weight = np.maximum(1.0 - (left / (4.0 * spread)) ** 2, 0.0)
    return float(slope), float(level), float(spread)


def _meeting(one: _Side, other: _Side) -> np.ndarray:
    share = np.linalg.solve(np.column_stack([one.along, -other.along]), other.point - one.point)
    return one.point + share[0] * one.along
