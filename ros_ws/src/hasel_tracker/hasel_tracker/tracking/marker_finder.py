# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Patches of marker colour in a picture, and the marker near a place in it, measured."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np

from hasel_tracker.tracking.marker_contour import OUTSIDE_PX
from hasel_tracker.tracking.marker_set import MarkerMeasurement
from hasel_tracker.tracking.tracker_settings import ColourRange, TrackerSettings

LEAST_AREA_SHARE = 0.4
MOST_AREA_SHARE = 2.5
SINGLE_PIXELS = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))
Measure = Callable[[np.ndarray, np.ndarray, int], MarkerMeasurement | None]

SPARE_PX = 4


@dataclass(frozen=True)
class Blob:
    """A connected patch: centre (2,) [px], area [px²], roundness (0 to 1) from its bounding box.

    cut: it touches the picture's edge, so that its centre and area may be those of a part.
    """

    centre: np.ndarray
    area: float
    roundness: float
    cut: bool = False

    @property
    def radius(self) -> float:
        """Radius of the disc of equal area [px]."""
        return float(np.sqrt(self.area / np.pi))


def find_blobs(mask: np.ndarray, minimum_area: float) -> list[Blob]:
    """Connected patches of a binary mask, the largest first; positions in the mask's pixels."""
    count, _, statistics, centres = cv2.connectedComponentsWithStats(mask, connectivity=8)
    blobs = []
    for number in range(1, count):
        area = float(statistics[number, cv2.CC_STAT_AREA])
        if area < minimum_area:
            continue
        left, top, width, height = (int(value) for value in statistics[number, :4])
        cut = min(left, top) == 0 or left + width == mask.shape[1] or top + height == mask.shape[0]
        slimness = min(width, height) / max(width, height)
        filled = min(area / (0.25 * np.pi * width * height), 1.0)
        blobs.append(Blob(centres[number].copy(), area, float(slimness * filled), cut))
    return sorted(blobs, key=lambda blob: -blob.area)


def blobs_in_frame(image: np.ndarray, gate: ColourRange, step: int, minimum_radius: float) -> list[Blob]:
    """Candidates in a whole frame, of which every `step`-th pixel is looked at; in full pixels."""
    coarse = np.ascontiguousarray(image[::step, ::step])
    mask = gate.mask(coarse)
    found = find_blobs(mask, max(np.pi * minimum_radius**2 / step**2, 3.0))
    return [Blob(blob.centre * step, blob.area * step**2, blob.roundness, blob.cut) for blob in found]


@dataclass(frozen=True)
class BlobOutline:
    """The contour (n, 1, 2) nearest to a prediction, its distance from it, and that of the next like it [px]."""

    contour: np.ndarray
    distance_px: float
    rival_px: float


def nearest_outline(mask: np.ndarray, predicted: np.ndarray, area: float) -> BlobOutline | None:
    """Outer contour of the patch of about `area` [px²] nearest to `predicted` (2,), or None."""
    opened = cv2.morphologyEx(mask, cv2.MORPH_OPEN, SINGLE_PIXELS)
    contours, _ = cv2.findContours(opened, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    found = []
    for contour in contours:
        # A contour runs through the centres of the outermost pixels.
        enclosed = cv2.contourArea(contour) + 0.5 * len(contour) + 1.0
        if not LEAST_AREA_SHARE * area < enclosed < MOST_AREA_SHARE * area:
            continue
        x, y, width, height = cv2.boundingRect(contour)
        middle = x + 0.5 * (width - 1), y + 0.5 * (height - 1)
        found.append((float(np.hypot(middle[0] - predicted[0], middle[1] - predicted[1])), contour))
    if not found:
        return None
    found.sort(key=lambda each: each[0])
    return BlobOutline(found[0][1], found[0][0], found[1][0] if len(found) > 1 else float("inf"))


@dataclass(frozen=True)
class MarkerFinder:
    """Looks for marker colour as `settings` says and locates it with `measure_within` its outline."""

    settings: TrackerSettings
    measure_within: Measure

    def for_light_of(self, image: np.ndarray) -> "MarkerFinder":
        """The same with the marker's colour as it is in this picture's light."""
        return replace(self, settings=replace(self.settings, colour=self.settings.colour.for_light_of(image)))

    def near(
        self, image: np.ndarray, place: np.ndarray, area: float, margin_px: float
    ) -> tuple[MarkerMeasurement | None, BlobOutline | None]:
        """The marker of about `area` [px²] nearest to `place` (2,), if there is one in reach."""
        radius = np.sqrt(area / np.pi)
        reach = int(radius + self.settings.edge_px + OUTSIDE_PX + SPARE_PX + int(margin_px))
        left, top = np.rint(place).astype(int) - reach
        right, bottom = left + 2 * reach + 1, top + 2 * reach + 1
        left, top = max(left, 0), max(top, 0)
        region = image[top : max(bottom, 0), left : max(right, 0)]
        if min(region.shape[:2]) < 2 * radius:
            return None, None
        outline = nearest_outline(self.settings.colour.mask(region), place - [left, top], area)
        if outline is None:
            return None, None
        measurement = self.measure_within(region, outline.contour, self.settings.edge_px)
        if measurement is None:
            return None, None
        return measurement.moved_by(np.array([left, top], float)), outline

    def of_blobs(self, image: np.ndarray, blobs: Sequence[Blob]) -> list[MarkerMeasurement | None]:
        """Each blob measured as a marker; None where its edge is not clear."""
        return [self.near(image, blob.centre, blob.area, self.settings.region_px)[0] for blob in blobs]
