"""Patches of marker colour in an image, as candidates for markers."""

from dataclasses import dataclass

import cv2
import numpy as np

from hasel_tracker.colour_gate import ColourRange

LEAST_AREA_SHARE = 0.4
MOST_AREA_SHARE = 2.5


@dataclass(frozen=True)
class Blob:
    """A connected patch: centre (2,) [px], area [px²], and how much of its bounding ellipse it fills (0 to 1)."""

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
    """Candidates in a whole frame, looked at with every `step`-th pixel; positions and areas in full pixels."""
    coarse = np.ascontiguousarray(image[::step, ::step])
    mask = gate.mask(coarse)
    found = find_blobs(mask, max(np.pi * minimum_radius**2 / step**2, 3.0))
    return [Blob(blob.centre * step, blob.area * step**2, blob.roundness) for blob in found]


def nearest_blob(mask: np.ndarray, predicted: np.ndarray, area: float) -> np.ndarray | None:
    """Mask of the patch of about `area` [px²] that is nearest to `predicted` (2,) [px]; None if there is none."""
    count, labels, statistics, centres = cv2.connectedComponentsWithStats(mask, connectivity=8)
    areas = statistics[1:count, cv2.CC_STAT_AREA]
    fitting = np.flatnonzero((areas > LEAST_AREA_SHARE * area) & (areas < MOST_AREA_SHARE * area)) + 1
    if not len(fitting):
        return None
    distance = np.linalg.norm(centres[fitting] - predicted, axis=1)
    return np.where(labels == fitting[distance.argmin()], np.uint8(255), np.uint8(0))
