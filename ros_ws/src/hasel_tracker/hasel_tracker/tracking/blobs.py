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
