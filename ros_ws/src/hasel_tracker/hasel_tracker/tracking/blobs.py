"""Patches of marker colour in an image, as candidates for markers."""

from dataclasses import dataclass

import cv2
import numpy as np

from hasel_tracker.tracking.colour_gate import ColourRange

LEAST_AREA_SHARE = 0.4
MOST_AREA_SHARE = 2.5
SINGLE_PIXELS = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))


@dataclass(frozen=True)
class Blob:
    """A connected patch: centre (2,) [px], area [px²], and roundness (0 to 1) from its bounding box."""

    centre: np.ndarray
    area: float
    roundness: float

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
        width, height = statistics[number, cv2.CC_STAT_WIDTH], statistics[number, cv2.CC_STAT_HEIGHT]
        slimness = min(width, height) / max(width, height)
        filled = min(area / (0.25 * np.pi * width * height), 1.0)
        blobs.append(Blob(centres[number].copy(), area, float(slimness * filled)))
    return sorted(blobs, key=lambda blob: -blob.area)


def blobs_in_frame(image: np.ndarray, gate: ColourRange, step: int, minimum_radius: float) -> list[Blob]:
    """Candidates in a whole frame, of which every `step`-th pixel is looked at; in full pixels."""
    coarse = np.ascontiguousarray(image[::step, ::step])
    mask = gate.mask(coarse)
    found = find_blobs(mask, max(np.pi * minimum_radius**2 / step**2, 3.0))
    return [Blob(blob.centre * step, blob.area * step**2, blob.roundness) for blob in found]


def nearest_outline(mask: np.ndarray, predicted: np.ndarray, area: float) -> np.ndarray | None:
    """Outer contour (n, 1, 2) of the patch of about `area` [px²] nearest to `predicted` (2,), or None."""
    opened = cv2.morphologyEx(mask, cv2.MORPH_OPEN, SINGLE_PIXELS)
    outlines, _ = cv2.findContours(opened, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    nearest, shortest = None, np.inf
    for outline in outlines:
        # A contour runs through the centres of the outermost pixels.
        enclosed = cv2.contourArea(outline) + 0.5 * len(outline) + 1.0
        if not LEAST_AREA_SHARE * area < enclosed < MOST_AREA_SHARE * area:
            continue
        x, y, width, height = cv2.boundingRect(outline)
        distance = np.hypot(x + 0.5 * width - predicted[0], y + 0.5 * height - predicted[1])
        if distance < shortest:
            nearest, shortest = outline, distance
    return nearest
