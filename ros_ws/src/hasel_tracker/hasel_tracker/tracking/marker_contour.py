# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where a marker is, from its edge: the half-level crossing along rays from its middle, and an ellipse through them.

On every ray the marker's level and the level just outside are known, and the edge is where the signal is half-way
between: structure beyond (an electrode, the body's edge, a grain of the ground) changes that ray's outer level and
little else. Rays on which something lies over the edge do not fit the ellipse and lose their weight.
"""

from dataclasses import replace
from functools import lru_cache

import cv2
import numpy as np

from hasel_tracker.tracking.marker_moment import chroma_axis, middle_value
from hasel_tracker.tracking.marker_set import MarkerMeasurement

RAYS = 64
STEP_PX = 0.5
OUTSIDE_PX = 2.5
MINIMUM_CONTRAST = 12.0
MINIMUM_INLIERS = 0.45
REWEIGHTINGS = 5
CLEAN_EDGE_PX = 0.35
CORRELATED_PX = 2.0
SPREAD_AT_HALF_QUALITY_PX = 0.8


def measure_contour(image: np.ndarray, outline: np.ndarray, edge_px: int) -> MarkerMeasurement | None:
    """Measure the marker that the contour `outline` (n, 1, 2) roughly encloses in an 8-bit BGR region.

    The edge is searched within `edge_px` of the outline's convex hull. The centre is in the region's pixels. None if
    the marker has no contrast, leaves the region, or shows too little of its edge.
    """
    hull = cv2.convexHull(outline)
    x, y, width, height = cv2.boundingRect(hull)
    reach = edge_px + OUTSIDE_PX + 1
    if min(x, y) < reach or x + width > image.shape[1] - reach or y + height > image.shape[0] - reach:
        return None
    start, radius = _rough_circle(hull)
    rough = _hull_radius(hull[:, 0].astype(float) - start, radius)
    solidity = min(cv2.contourArea(outline) / max(cv2.contourArea(hull), 1.0), 1.0)
    left, top = int(x - reach - 1), int(y - reach - 1)
    left, top = max(left, 0), max(top, 0)
    region = image[top : int(y + height + reach + 2), left : int(x + width + reach + 2)]
    best = None
    for signal in (_luma, _colour):
        found = _measure(signal(region, start - (left, top), radius), start - (left, top), rough, edge_px)
        if found is not None and (best is None or found.sigma_px < best.sigma_px):
            best = found
        if best is not None and best.noise < CLEAN_EDGE_PX:
            break
    if best is None:
        return None
    return replace(best, centre=best.centre + (left, top), solidity=min(solidity, best.solidity))


def _luma(region: np.ndarray, _start: np.ndarray, _radius: float) -> np.ndarray:
    return cv2.cvtColor(region, cv2.COLOR_BGR2GRAY).astype(np.float32)


def _colour(region: np.ndarray, start: np.ndarray, radius: float) -> np.ndarray:
    """Colour along the axis from marker to background, brightness left out; smoothed, as video stores half of it."""
    inside = np.zeros(region.shape[:2], np.uint8)
    cv2.circle(inside, tuple(int(v) for v in np.rint(start)), max(int(0.6 * radius), 1), 255, cv2.FILLED)
    outside = np.full(region.shape[:2], 255, np.uint8)
    cv2.circle(outside, tuple(int(v) for v in np.rint(start)), int(radius + 3), 0, cv2.FILLED)
    axis = chroma_axis(region, inside, outside)
    return (region @ axis).astype(np.float32)


def _rough_circle(hull: np.ndarray) -> tuple[np.ndarray, float]:
    moments = cv2.moments(hull)
    if moments["m00"] <= 0.0:
        (x, y), radius = cv2.minEnclosingCircle(hull)
        return np.array([x, y]), radius + 0.5
    centre = np.array([moments["m10"], moments["m01"]]) / moments["m00"]
    # A contour runs through the centres of the outermost pixels.
    return centre, float(np.sqrt(moments["m00"] / np.pi) + 0.5)


def _hull_radius(corners: np.ndarray, radius: float) -> np.ndarray:
    """Distance [px] of the hull from its middle in the direction of each ray."""
    after = np.roll(corners, -1, axis=0)
    edge = after - corners
    normal = np.column_stack([edge[:, 1], -edge[:, 0]])
    distance = (corners * normal).sum(axis=1)
    normal, distance = np.where(distance[:, None] < 0, -normal, normal), np.abs(distance)
    along = _directions() @ normal.T
    with np.errstate(divide="ignore", invalid="ignore"):
        ray = np.where(along > 1e-9, distance / along, np.inf)
    return np.clip(ray.min(axis=1), 0.3 * radius, 3.0 * radius) + 0.5


@lru_cache(maxsize=1)
def _directions() -> np.ndarray:
    angle = 2.0 * np.pi * np.arange(RAYS) / RAYS
    return np.column_stack([np.cos(angle), np.sin(angle)])


def _measure(
    signal: np.ndarray, start: np.ndarray, rough: np.ndarray, edge_px: int
) -> MarkerMeasurement | None:
    direction = _directions()
    steps = np.arange(-edge_px - 1.0, edge_px + OUTSIDE_PX, STEP_PX)
    reach = np.maximum(rough[:, None] + steps, 0.0)
    points = (start + reach[..., None] * direction[:, None, :]).astype(np.float32)
    values = cv2.remap(
        signal, points[..., 0], points[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )
    middle = start + 0.5 * (rough[:, None] * direction)
    inner = cv2.remap(
        signal, middle[None, :, 0].astype(np.float32), middle[None, :, 1].astype(np.float32), cv2.INTER_LINEAR
    )
    inside = middle_value(inner.ravel())
    outer = values[:, steps >= 1.0]
    if middle_value(outer.ravel()) < inside:
        values, outer, inside = -values, -outer, -inside
    level = np.partition(outer, -2, axis=1)[:, -2]
    contrast = middle_value(level - inside)
    if contrast < MINIMUM_CONTRAST:
        return None
    crossing = _crossings(values, 0.5 * (level + inside), reach, rough)
    usable = np.isfinite(crossing) & (level - inside > 0.4 * contrast)
    if usable.mean() < MINIMUM_INLIERS:
        return None
    edge = start + crossing[:, None] * direction
    fit = _ellipse(edge[usable], start, middle_value(rough))
    if fit is None:
        return None
    centre, area, spread, weight = fit
    share = float(weight.sum() / RAYS)
    if share < MINIMUM_INLIERS:
        return None
    independent = share * min(RAYS, 2.0 * np.sqrt(np.pi * area) / CORRELATED_PX)
    sigma = spread * np.sqrt(2.0 / independent)
    clarity = 1.0 / (1.0 + (spread / SPREAD_AT_HALF_QUALITY_PX) ** 2)
    return MarkerMeasurement(centre, area, contrast, spread, share, float(sigma), float(clarity))


def _crossings(values: np.ndarray, half: np.ndarray, reach: np.ndarray, rough: np.ndarray) -> np.ndarray:
    """Distance [px] at which each ray leaves the marker: the upward crossing nearest to the outline, or NaN."""
    below = values - half[:, None]
    rises = (below[:, :-1] < 0.0) & (below[:, 1:] >= 0.0)
    step = below[:, 1:] - below[:, :-1]
    share = np.where(rises, -below[:, :-1] / np.where(rises, step, 1.0), 0.0)
    place = reach[:, :-1] + share * (reach[:, 1:] - reach[:, :-1])
    apart = np.where(rises, np.abs(place - rough[:, None]), np.inf)
    nearest = apart.argmin(axis=1)
    rays = np.arange(len(values))
    return np.where(rises.any(axis=1), place[rays, nearest], np.nan)


def _ellipse(
    points: np.ndarray, start: np.ndarray, radius: float
) -> tuple[np.ndarray, float, float, np.ndarray] | None:
    """Centre (2,), area, spread of the edge about the ellipse [px], and weights of the points (n, 2).

    About its centre, the radius of a slight ellipse is R + p cos 2φ + q sin 2φ; a shift of the centre adds
    a cos φ + b sin φ.
    """
    centre, one = start.copy(), np.ones(len(points))
    weight = one
    for _ in range(REWEIGHTINGS):
        offset = points - centre
        distance = np.hypot(offset[:, 0], offset[:, 1])
        cosine, sine = offset[:, 0] / distance, offset[:, 1] / distance
        design = np.stack([one, cosine, sine, cosine**2 - sine**2, 2.0 * cosine * sine])
        weighted = design * weight
        try:
            found = np.linalg.solve(weighted @ design.T, weighted @ distance)
        except np.linalg.LinAlgError:
            return None
        left = distance - found @ design
        spread = 1.48 * middle_value(np.abs(left)) + 0.02
        # Tukey's weights: what is far off has none.
        weight = np.square(np.maximum(1.0 - np.square(left / (4.0 * spread)), 0.0))
        centre = centre + found[1:3]
        if not np.hypot(*(centre - start)) < radius:
            return None
    spread = float(np.sqrt(weight @ np.square(left) / weight.sum()))
    radius = found[0]
    area = np.pi * (radius**2 - 0.5 * (found[3] ** 2 + found[4] ** 2))
    return centre, float(area), spread, weight
