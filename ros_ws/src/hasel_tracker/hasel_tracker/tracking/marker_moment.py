# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where a marker is, to some thousandths of a pixel: the moment of its luma, corrected for the background.

Colour says which pixels belong to the marker, but its edges are unreliable: video stores colour at half
resolution. Luma is stored in full. Inside the marker every pixel counts one, outside none, and in the
narrow band around its edge a pixel counts by how far its luma is from the background's towards the
marker's. So a highlight inside the marker changes nothing, and noise enters only through the band. The
background is a plane (uneven light). Directions in which something else crosses it (the spine, an edge of
the body) are left out together with the opposite ones: what remains of a disc, an ellipse or a motion-
blurred disc is still symmetric about its centre.

Over a textured background no plane fits the luma. Then colour, blurred as it is, does better: the same
moment is taken of it along the line from the background's colour to the marker's, leaving brightness out.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np

from hasel_tracker.tracking.marker_set import MarkerMeasurement

RING_WIDTH_PX = 3
MINIMUM_CONTRAST = 12.0
MINIMUM_INSIDE_PX = 5
REFINEMENTS = 2
TEXTURED = 0.16
NOISE_AT_HALF_QUALITY = 0.25
CHROMA_BLUR_PX = 1
DIRECTIONS = 48
FINE_SECTORS = 8 * DIRECTIONS
WIDENING = 2
MINIMUM_OPEN_SHARE = 0.3
REWEIGHTINGS = 4


@dataclass(frozen=True)
class MarkerSurroundings:
    """Background about `origin` (2,): plane (level, slopes in x and y), noise, crossed directions (48,)."""

    origin: np.ndarray
    plane: np.ndarray
    noise: float
    crossed: np.ndarray

    def level(self, shape: tuple[int, int]) -> np.ndarray:
        """Luma of the background on every pixel of a region of this shape."""
        x = np.arange(shape[1], dtype=np.float32) - self.origin[0]
        y = np.arange(shape[0], dtype=np.float32) - self.origin[1]
        across = (self.plane[0] + self.plane[1] * x).astype(np.float32)
        return across[None, :] + (self.plane[2] * y).astype(np.float32)[:, None]

    def open_window(self, symmetric: bool) -> np.ndarray | None:
        """Smooth weight by fine sector, zero where something crosses (or opposite, if `symmetric`).

        None when too few directions are left to locate the marker both ways.
        """
        closed = self.crossed
        if symmetric:
            closed = closed | np.roll(closed, DIRECTIONS // 2)
        closed = closed[_NEIGHBOURS].any(axis=1)
        if 1.0 - closed.mean() < MINIMUM_OPEN_SHARE:
            return None
        return ~closed @ _SMOOTHING


def _neighbours(reach: int) -> np.ndarray:
    return (np.arange(DIRECTIONS)[:, None] + np.arange(-reach, reach + 1)) % DIRECTIONS


def _smoothing() -> np.ndarray:
    """Matrix (DIRECTIONS, FINE_SECTORS) from open or closed directions to a smooth window."""
    direction = (np.arange(DIRECTIONS) + 0.5) / DIRECTIONS
    sector = (np.arange(FINE_SECTORS) + 0.5) / FINE_SECTORS
    apart = np.abs((direction[:, None] - sector[None, :] + 0.5) % 1.0 - 0.5) * DIRECTIONS
    weight = np.maximum(3.0 - apart, 0.0)
    return weight / weight.sum(axis=0)


_NEIGHBOURS = _neighbours(WIDENING)
_SMOOTHING = _smoothing()


def look_around(luma: np.ndarray, inside: np.ndarray, ring: np.ndarray) -> MarkerSurroundings:
    """Describe the background in `ring` around the marker that covers `inside` (masks of the same shape)."""
    rows, columns = np.nonzero(inside)
    origin = np.array([columns.mean(), rows.mean()])
    rows, columns = np.nonzero(ring)
    x, y, values = columns - origin[0], rows - origin[1], luma[rows, columns]
    direction = sector_of(x, y) // (FINE_SECTORS // DIRECTIONS)
    count = np.bincount(direction, minlength=DIRECTIONS)
    seen = count > 0
    share = 1.0 / np.maximum(count, 1)
    mean_x, mean_y, mean_value = (np.bincount(direction, each, DIRECTIONS) * share for each in (x, y, values))
    design = np.column_stack([np.ones(DIRECTIONS), mean_x, mean_y])
    plane, left, spread = _robust_plane(design, mean_value, seen)
    crossed = seen & (np.abs(left) > 4.0 * spread + 1.0)
    noise = spread / np.sqrt(middle_value(share[seen]))
    return MarkerSurroundings(origin, plane, float(noise), crossed)


def _robust_plane(
    design: np.ndarray, values: np.ndarray, seen: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """Plane through most of the sector means, what is left of each, and its typical size."""
    weight = seen.astype(float)
    for _ in range(REWEIGHTINGS):
        weighted = design * weight[:, None]
        plane = np.linalg.solve(weighted.T @ design + 1e-9 * np.eye(3), weighted.T @ values)
        left = values - design @ plane
        spread = 1.5 * middle_value(np.abs(left[seen])) + 0.1
        weight = seen / np.maximum(np.abs(left) / spread, 1.0) ** 2
    return plane, left, spread


def sector_of(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Number of the fine sector, counted from +x towards +y, in which an offset lies."""
    turn = np.arctan2(y, x) * (0.5 / np.pi)
    return np.floor(turn * FINE_SECTORS).astype(np.int64) % FINE_SECTORS


def middle_value(values: np.ndarray) -> float:
    """The median of a small array (the upper one of two), much faster than numpy's for these sizes."""
    half = len(values) // 2
    return float(np.partition(values, half)[half])


def measure_marker(image: np.ndarray, outline: np.ndarray, edge_px: int) -> MarkerMeasurement | None:
    """Measure the marker that the contour `outline` (n, 1, 2) roughly encloses in an 8-bit BGR region.

    `edge_px` is half the width of the band in which its edge lies. The centre is in the region's pixels. None
    if the marker has no inside left, no contrast, or its surroundings leave the region.
    """
    by_luma = _measure(image, outline, edge_px, _luma)
    if by_luma is not None and by_luma.noise < TEXTURED * by_luma.contrast:
        return by_luma
    by_colour = _measure(image, outline, edge_px + CHROMA_BLUR_PX, _colourfulness)
    measured = [each for each in (by_luma, by_colour) if each is not None]
    return min(measured, key=lambda each: each.noise / each.contrast, default=None)


def _measure(
    image: np.ndarray, outline: np.ndarray, edge_px: int, signal_of: Callable[..., np.ndarray]
) -> MarkerMeasurement | None:
    # Convex: a highlight or a notch at the edge is part of the marker.
    hull = cv2.convexHull(outline)
    x, y, width, height = cv2.boundingRect(hull)
    reach = edge_px + RING_WIDTH_PX + 1
    left, top, right, bottom = x - reach, y - reach, x + width + reach, y + height + reach
    if left < 0 or top < 0 or right > image.shape[1] or bottom > image.shape[0]:
        return None
    filled = np.zeros((bottom - top, right - left), np.uint8)
    cv2.fillConvexPoly(filled, hull - np.array([left, top], np.int32), 255)
    inside = cv2.erode(filled, _disc(edge_px))
    outer = cv2.dilate(filled, _disc(edge_px))
    ring = cv2.dilate(outer, _disc(RING_WIDTH_PX)) ^ outer
    if cv2.countNonZero(inside) < MINIMUM_INSIDE_PX:
        return None
    signal = signal_of(image[top:bottom, left:right], inside, ring)
    surroundings = look_around(signal, inside, ring)
    share, contrast = _marker_share(signal, inside, outer, surroundings, follows_light=signal_of is _luma)
    if contrast < MINIMUM_CONTRAST:
        return None
    centre, area = _centre_and_area(share, outer, surroundings)
    solidity = min(cv2.contourArea(outline) / max(cv2.contourArea(hull), 1.0), 1.0)
    noise = surroundings.noise / contrast
    band = 2.0 * edge_px * 2.0 * np.sqrt(np.pi * area)
    sigma_px = noise * np.sqrt(0.5 * band * area / np.pi) / area
    clarity = 1.0 / (1.0 + (noise / NOISE_AT_HALF_QUALITY) ** 2)
    return MarkerMeasurement(
        np.add(centre, (left, top)),
        area,
        contrast,
        surroundings.noise,
        solidity,
        float(sigma_px),
        float(clarity),
    )


def _luma(region: np.ndarray, _inside: np.ndarray, _ring: np.ndarray) -> np.ndarray:
    return cv2.cvtColor(region, cv2.COLOR_BGR2GRAY).astype(np.float32)


def _colourfulness(region: np.ndarray, inside: np.ndarray, ring: np.ndarray) -> np.ndarray:
    return (region @ chroma_axis(region, inside, ring)).astype(np.float32)


def chroma_axis(region: np.ndarray, inside: np.ndarray, outside: np.ndarray) -> np.ndarray:
    """Unit vector (3,) of colour from the marker to the background, brightness left out; masks are 8-bit."""
    axis = np.subtract(cv2.mean(region, outside)[:3], cv2.mean(region, inside)[:3])
    axis -= axis.mean()
    return axis / max(np.linalg.norm(axis), 1e-9)


def _marker_share(
    signal: np.ndarray,
    inside: np.ndarray,
    outer: np.ndarray,
    surroundings: MarkerSurroundings,
    *,
    follows_light: bool,
) -> tuple[np.ndarray, float]:
    """How much of each pixel is marker, and the contrast [grey levels]."""
    level = surroundings.level(signal.shape)
    marker_level = middle_value(signal[inside > 0])
    if follows_light:
        # The light on the marker varies as the light on its surroundings.
        marker_level = marker_level / surroundings.plane[0] * level
    contrast = level - marker_level
    share = (level - signal) / np.where(np.abs(contrast) > 1.0, contrast, 1.0)
    share[inside > 0] = 1.0
    share[outer == 0] = 0.0
    return share, float(abs(contrast.mean()))


def _centre_and_area(
    share: np.ndarray, outer: np.ndarray, surroundings: MarkerSurroundings
) -> tuple[np.ndarray, float]:
    """Centre (2,) and area of the marker, from the directions that nothing else crosses, or all if too few."""
    rows, columns = np.nonzero(outer)
    weights = share[rows, columns]
    positions = np.column_stack([columns, rows]).astype(float)
    area = float(weights.sum())
    centre = weights @ positions / area
    if not surroundings.crossed.any():
        return centre, area
    window = surroundings.open_window(symmetric=True)
    if window is not None:
        return _symmetric_centre(weights, positions, centre, window)
    window = surroundings.open_window(symmetric=False)
    return (centre, area) if window is None else _disc_centre(weights, positions, centre, window)


def _symmetric_centre(
    weights: np.ndarray, positions: np.ndarray, centre: np.ndarray, window: np.ndarray
) -> tuple[np.ndarray, float]:
    """The point about which the first moment within a symmetric window vanishes, and the area seen from there."""
    zeroth, _, second = _window_moments(window)
    for _ in range(REFINEMENTS):
        offset = positions - centre
        seen = weights * window[sector_of(offset[:, 0], offset[:, 1])]
        area = 2.0 * np.pi * float(seen.sum()) / zeroth
        centre = centre + np.linalg.solve(second * area / np.pi, seen @ offset)
    return centre, area


def _disc_centre(
    weights: np.ndarray, positions: np.ndarray, centre: np.ndarray, window: np.ndarray
) -> tuple[np.ndarray, float]:
    """Centre and area of the disc with the area and first moment seen within a window of any shape.

    A disc of radius R off by d has ∮ w (R² / 2 + R d·n) dφ and ∮ w (R³ / 3 + R² d·n) n dφ.
    """
    zeroth, first, second = _window_moments(window)
    radius = np.sqrt(weights.sum() / np.pi)
    for _ in range(2 * REFINEMENTS):
        offset = positions - centre
        seen = weights * window[sector_of(offset[:, 0], offset[:, 1])]
        found = np.array([seen.sum(), *(seen @ offset)])
        expected = np.array([0.5 * radius**2 * zeroth, *(radius**3 / 3.0 * first)])
        change = np.empty((3, 3))
        change[0] = [radius * zeroth, *(radius * first)]
        change[1:, 0] = radius**2 * first
        change[1:, 1:] = radius**2 * second
        step = np.linalg.solve(change, found - expected)
        radius, centre = radius + step[0], centre + step[1:]
    return centre, float(np.pi * radius**2)


def _window_moments(window: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """∮ w dφ, ∮ w n dφ (2,) and ∮ w n nᵀ dφ (2, 2) over the directions n."""
    step = 2.0 * np.pi / len(window)
    angle = (np.arange(len(window)) + 0.5) * step
    normal = np.stack([np.cos(angle), np.sin(angle)])
    weighted = window * normal * step
    return float(window.sum() * step), weighted.sum(axis=1), weighted @ normal.T


@lru_cache(maxsize=32)
def _disc(radius: int) -> np.ndarray:
    return cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1, 2 * radius + 1))
