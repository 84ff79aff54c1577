"""Learn the markers' colour range, size and spacing from one frame."""

from dataclasses import dataclass, replace

import cv2
import numpy as np

from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.marker_contour import measure_contour
from hasel_tracker.tracking.marker_search import NUMBERS, search_start
from hasel_tracker.tracking.marker_tracker import MarkerTracker
from hasel_tracker.tracking.tracker_settings import HUE_CIRCLE, ColourRange, TrackerSettings

SEED_RADIUS_PX = 3
HUE_MARGIN = 8
MARGIN_SHARE = 0.6
REGION_RADII = 1.4


@dataclass(frozen=True)
class LearnedColour:
    """The settings, the markers found with them (m, 2) [px], the share of other pixels in the range."""

    settings: TrackerSettings
    markers_px: np.ndarray
    stray_share: float

    def __str__(self) -> str:
        colour, radius = self.settings.colour, self.settings.marker_radius_px
        return (
            f"Markers of hue {colour.hue_low} to {colour.hue_high}, saturation from {colour.saturation_low}, value "
            f"from {colour.value_low}, radius {radius:.1f} px, {self.settings.spacing.replace(',', ' and ')} px apart; "
            f"{100.0 * self.stray_share:.2g} % of the other pixels have that colour too."
        )


def learn_colour(
    image: np.ndarray,
    points_px: np.ndarray | None = None,
    start: TrackerSettings = TrackerSettings(),  # noqa: B008
) -> LearnedColour:
    """Learn from an 8-bit BGR frame; `points_px` (m, 2) are pixels on the markers, or None to find them.

    Raises TrackerError if the markers are not found with what was learned.
    """
    if points_px is not None:
        start = replace(start, marker_count=len(points_px))
    centres = _found_centres(image, start) if points_px is None else np.asarray(points_px, float)
    colour = _range_around(cv2.cvtColor(image, cv2.COLOR_BGR2HSV), centres)
    radius = _radius(colour.mask(image), centres)
    region = max(start.region_px, round(REGION_RADII * radius))
    settings = replace(start, colour=colour, marker_radius_px=round(radius, 1), region_px=region)
    tracker = MarkerTracker(settings, measure_contour)
    try:
        markers = tracker.update(image, 0.0) if points_px is None else tracker.place(image, centres, 0.0)
        markers = markers if markers.found.all() else tracker.place(image, centres, 0.0)
    except TrackerError as error:
        raise TrackerError(f"With the colour learned the markers are not found: {error}") from error
    apart = np.linalg.norm(np.diff(markers.positions, axis=0), axis=1)
    settings = replace(settings, spacing=",".join(f"{each:.1f}" for each in apart))
    return LearnedColour(
        settings, markers.positions, _stray_share(colour.mask(image), markers.positions, radius)
    )


def _found_centres(image: np.ndarray, start: TrackerSettings) -> np.ndarray:
    search = search_start(image, start)
    if search.row is None:
        raise TrackerError(
            f"With the starting colour: {search.note}; point at the markers with --at X,Y X,Y …, head first."
        )
    return search.row.centres


def _range_around(hsv: np.ndarray, centres: np.ndarray) -> ColourRange:
    height, width = hsv.shape[:2]
    samples = []
    for x, y in np.rint(centres).astype(int):
        if not (0 <= x < width and 0 <= y < height):
            raise TrackerError(f"The point {x},{y} is outside the image of {width} × {height} px.")
        patch = hsv[
            max(y - SEED_RADIUS_PX, 0) : y + SEED_RADIUS_PX + 1,
            max(x - SEED_RADIUS_PX, 0) : x + SEED_RADIUS_PX + 1,
        ]
        samples.append(patch.reshape(-1, 3))
    pixels = np.vstack(samples).astype(float)
    angle = pixels[:, 0] * (2.0 * np.pi / HUE_CIRCLE)
    middle = np.arctan2(np.sin(angle).mean(), np.cos(angle).mean()) * HUE_CIRCLE / (2.0 * np.pi)
    apart = (pixels[:, 0] - middle + HUE_CIRCLE / 2) % HUE_CIRCLE - HUE_CIRCLE / 2
    low, high = np.percentile(apart, 1) - HUE_MARGIN, np.percentile(apart, 99) + HUE_MARGIN
    saturation, value = np.percentile(pixels[:, 1:], 5, axis=0) * MARGIN_SHARE
    return ColourRange(
        round(middle + low) % HUE_CIRCLE,
        round(middle + high) % HUE_CIRCLE,
        int(saturation),
        int(value),
    )


def _radius(mask: np.ndarray, centres: np.ndarray) -> float:
    _, labels, statistics, _ = cv2.connectedComponentsWithStats(mask)
    areas = []
    for x, y in np.rint(centres).astype(int):
        near = labels[max(y - 2, 0) : y + 3, max(x - 2, 0) : x + 3]
        if near.any():
            areas.append(statistics[near[near > 0][0], cv2.CC_STAT_AREA])
    if len(areas) < len(centres):
        raise TrackerError(
            f"The colour at the points given does not make {NUMBERS[len(centres)]} patches; point at the markers' "
            "middles."
        )
    return float(np.sqrt(np.median(areas) / np.pi))


def _stray_share(mask: np.ndarray, markers: np.ndarray, radius: float) -> float:
    outside = mask.copy()
    for x, y in np.rint(markers).astype(int):
        cv2.circle(outside, (int(x), int(y)), int(1.5 * radius) + 2, 0, cv2.FILLED)
    return cv2.countNonZero(outside) / outside.size
