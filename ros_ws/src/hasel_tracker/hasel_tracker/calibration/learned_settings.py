# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Learn from one picture the markers' colour, size and spacing, or how a swimmer without dots stands out."""

from dataclasses import dataclass, replace

import cv2
import numpy as np

from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.bending_tracker import TrackedFrame
from hasel_tracker.tracking.centre_line import CentreLine, centre_line
from hasel_tracker.tracking.marker_contour import measure_contour
from hasel_tracker.tracking.marker_search import NUMBERS, search_start
from hasel_tracker.tracking.marker_set import MarkerSet, bending_angle
from hasel_tracker.tracking.marker_tracker import MarkerTracker
from hasel_tracker.tracking.silhouette import Silhouette, find_silhouette
from hasel_tracker.tracking.tracker_settings import HUE_CIRCLE, ColourRange, TrackerSettings
from hasel_tracker.video.annotation import annotate

SEED_RADIUS_PX = 3
HUE_MARGIN = 8
MARGIN_SHARE = 0.6
REGION_RADII = 1.4
SELECTED, LINE = (255, 0, 255), (60, 220, 60)


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


def learned_picture(image: np.ndarray, learned: LearnedColour) -> np.ndarray:
    """The image greyed, pixels in the colour range in magenta, the markers found marked; 8-bit BGR."""
    grey = cv2.cvtColor(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY), cv2.COLOR_GRAY2BGR)
    grey[learned.settings.colour.mask(image) > 0] = SELECTED
    markers = MarkerSet(learned.markers_px, np.ones(3))
    tracked = TrackedFrame(0.0, markers, *bending_angle(learned.markers_px))
    return annotate(grey, tracked, f"{100 * learned.stray_share:.2g} % elsewhere")


@dataclass(frozen=True)
class LearnedBody:
    """The settings, the silhouette found with them, and its centre line."""

    settings: TrackerSettings
    silhouette: Silhouette
    line: CentreLine

    def __str__(self) -> str:
        return (
            f"A {self.settings.body} body of {self.line.length_px:.0f} px by "
            f"{2 * self.line.half_width_px.max():.0f} px, {2 * self.silhouette.threshold:.0f} grey levels from the "
            "ground."
        )


def learn_body(image: np.ndarray, body: str = "auto") -> LearnedBody:
    """Find the one slender body in an 8-bit BGR image; raises TrackerError with the reason where there is none."""
    search = find_silhouette(image, body)
    if search.silhouette is None:
        raise TrackerError(f"No swimmer was found: {search.note}.")
    line = centre_line(search.silhouette)
    if line is None:
        raise TrackerError(
            "No swimmer was found: what stands out from the ground is no slender body; leave it out with --roi."
        )
    settings = replace(TrackerSettings(), body="light" if search.silhouette.light else "dark")
    return LearnedBody(settings, search.silhouette, line)


def body_picture(image: np.ndarray, learned: LearnedBody) -> np.ndarray:
    """The image greyed, with the silhouette's outline in magenta and the centre line in green; 8-bit BGR."""
    grey = cv2.cvtColor(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY), cv2.COLOR_GRAY2BGR)
    corner = tuple(int(value) for value in learned.silhouette.corner)
    outline = cv2.findContours(
        learned.silhouette.mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE, offset=corner
    )[0]
    cv2.drawContours(grey, outline, -1, SELECTED, 1)
    points = np.rint(16 * learned.line.at(np.linspace(0.0, 1.0, 200))).astype(np.int32)
    cv2.polylines(grey, [points], False, LINE, 1, cv2.LINE_AA, 4)
    return grey
