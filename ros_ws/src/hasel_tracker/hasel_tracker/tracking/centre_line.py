# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The centre line of a silhouette: the ridge of its middle, refined by the two edges across it."""

from dataclasses import dataclass

import cv2
import numpy as np
from scipy.interpolate import BSpline, make_lsq_spline
from scipy.ndimage import median_filter
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from hasel_tracker.tracking.silhouette import Silhouette

SECTIONS = 96
SHRINK = 2
INTERVALS = 6
BLUNT_END = 0.8
SETTLED_PX = 0.5
DEGREE = 3
ROUNDS = 4
SAMPLE_PX = 0.5
BESIDE_PX = 5.0
ALIKE_SECTIONS = 9
END_REACH = 1.5
LEAST_SLENDERNESS = 4.0
LEAST_SECTIONS_SHARE = 0.8


@dataclass(frozen=True)
class CentreLine:
    """A smooth line through the middle of a body, from one end to the other, in either direction.

    half_width_px: (k,) at places evenly along it. scatter_px: how far the middles of the sections lie off the line
    (one standard deviation). spline: place (2,) [px] over the arc length from 0 to `length_px`, roughly; the exact arc
    length is tabulated in `_arc`.
    """

    spline: BSpline
    length_px: float
    half_width_px: np.ndarray
    scatter_px: float
    _parameter: np.ndarray
    _arc: np.ndarray
    _normal_inverse: np.ndarray

    def at(self, shares: np.ndarray) -> np.ndarray:
        """Places (n, 2) [px] at shares of the length, 0 to 1."""
        return self.spline(self._at(shares))

    def sigma_at(self, shares: np.ndarray) -> np.ndarray:
        """Standard deviation (n,) across the line [px] that the scatter of the sections explains."""
        rows = BSpline.design_matrix(self._at(shares), self.spline.t, DEGREE, extrapolate=True).toarray()
        return self.scatter_px * np.sqrt(np.einsum("ij,jk,ik->i", rows, self._normal_inverse, rows))

    def _at(self, shares: np.ndarray) -> np.ndarray:
        return np.interp(np.asarray(shares) * self.length_px, self._arc, self._parameter)


def centre_line(silhouette: Silhouette) -> CentreLine | None:
    """The centre line in the picture's pixels; None of what is no slender body, or where it does not settle."""
    path = _ridge(silhouette.mask)
    if path is None:
        return None
    line, moved = None, np.inf
    for _ in range(ROUNDS):
        path = _to_the_tips(silhouette, path)
        line = _through_the_middles(silhouette, path)
        if line is None:
            return None
        before, path = path, line.at(np.linspace(0.0, 1.0, SECTIONS)) - silhouette.corner
        moved = np.linalg.norm(path - before, axis=1).max()
    slender = line.length_px**2 > LEAST_SLENDERNESS * silhouette.area_px
    return line if slender and moved < SETTLED_PX else None


def _ridge(mask: np.ndarray) -> np.ndarray | None:
    """The longest way along the thinned mask (n, 2), evenly spaced, without the forks at its ends."""
    size = tuple(-(-length // SHRINK) for length in mask.shape[::-1])
    padded = np.pad(mask, ((0, size[1] * SHRINK - mask.shape[0]), (0, size[0] * SHRINK - mask.shape[1])))
    smaller = np.where(cv2.resize(padded, size, interpolation=cv2.INTER_AREA) > 0, np.uint8(255), np.uint8(0))
    thin = np.pad(cv2.ximgproc.thinning(smaller), 1)
    rows, columns = np.nonzero(thin)
    if len(rows) < 8:
        return None
    number = np.full(thin.shape, -1)
    number[rows, columns] = np.arange(len(rows))
    first, last, far = [], [], []
    for down, right in ((0, 1), (1, 0), (1, 1), (1, -1)):
        other = number[rows + down, columns + right]
        first.append(np.flatnonzero(other >= 0))
        last.append(other[other >= 0])
        far.append(np.full(len(last[-1]), np.hypot(down, right)))
    edges = (np.concatenate(far), (np.concatenate(first), np.concatenate(last)))
    graph = csr_matrix(edges, shape=(len(rows),) * 2)
    begin = int(np.argmax(_finite(dijkstra(graph, directed=False, indices=0))))
    way, before = dijkstra(graph, directed=False, indices=begin, return_predecessors=True)
    chain = [int(np.argmax(_finite(way)))]
    while before[chain[-1]] >= 0:
        chain.append(int(before[chain[-1]]))
    points = (np.column_stack([columns[chain], rows[chain]]) - 0.5) * SHRINK - 0.5  # of pixels' centres
    inner = _half_widths(mask, _inside(points, mask)) / SHRINK
    ends = round(inner[len(inner) // 10]), round(inner[-1 - len(inner) // 10])
    kept = points[ends[0] : len(points) - ends[1]]
    return _evenly(_smooth(kept), SECTIONS) if len(kept) >= 8 else None


def _finite(distance: np.ndarray) -> np.ndarray:
    return np.where(np.isfinite(distance), distance, -1.0)


def _half_widths(mask: np.ndarray, points: np.ndarray) -> np.ndarray:
    distance = cv2.distanceTransform(mask, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    columns, rows = np.rint(points).astype(int).T
    return distance[rows, columns]


def _smooth(points: np.ndarray) -> np.ndarray:
    """A moving mean over a tenth of the points, the ends kept by mirroring them through the last point."""
    reach = max(len(points) // 20, 1)
    before = 2 * points[0] - points[reach:0:-1]
    behind = 2 * points[-1] - points[-2 : -2 - reach : -1]
    longer = np.vstack([before, points, behind])
    mean = np.ones(2 * reach + 1) / (2 * reach + 1)
    return np.column_stack([np.convolve(longer[:, axis], mean, "valid") for axis in (0, 1)])


def _evenly(points: np.ndarray, count: int) -> np.ndarray:
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    where = np.linspace(0.0, arc[-1], count)
    return np.column_stack([np.interp(where, arc, points[:, axis]) for axis in (0, 1)])


def _to_the_tips(silhouette: Silhouette, path: np.ndarray) -> np.ndarray:
    """The path with both ends moved, straight on, to where the silhouette ends."""
    for _ in range(2):
        path = path[::-1]
        straight = path[-1] - path[-6]
        straight /= np.linalg.norm(straight)
        reach = END_REACH * np.sqrt(silhouette.area_px / 4.0)
        away = np.arange(-4.0, reach, SAMPLE_PX)
        end = _first_below(_sampled(silhouette, path[-1] + away[:, None] * straight), silhouette.threshold)
        tip = path[-1] + (away[0] + (end if np.isfinite(end) else 8.0) * SAMPLE_PX) * straight
        kept = path[(path - tip) @ straight < -1.0]
        path = np.vstack([kept, tip])
    return _evenly(path, SECTIONS)


def _through_the_middles(silhouette: Silhouette, path: np.ndarray) -> CentreLine | None:
    """A spline through the middles between the two edges across the path."""
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    tangent = np.gradient(path, axis=0)
    tangent = np.column_stack([np.convolve(np.pad(t, 2, "edge"), np.ones(5), "valid") for t in tangent.T])
    normal = np.column_stack([-tangent[:, 1], tangent[:, 0]])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    reach = 1.5 * float(_half_widths(silhouette.mask, _inside(path, silhouette.mask)).max()) + 4.0
    away = np.arange(0.0, reach, SAMPLE_PX)
    edges = []
    for side in (1.0, -1.0):
        places = path[:, None] + side * away[None, :, None] * normal[:, None]
        edges.append(SAMPLE_PX * _edge(_sampled(silhouette, places), silhouette.threshold))
    middle = path + 0.5 * (edges[0] - edges[1])[:, None] * normal
    half_width = 0.5 * (edges[0] + edges[1])
    good = np.isfinite(half_width)
    # Across a blunt end a section that is a little askew tells little, and would tilt the next one more.
    from_end = np.minimum(arc, arc[-1] - arc)
    good &= from_end > np.maximum(BLUNT_END * np.nan_to_num(half_width), 1.0)
    if good.sum() < LEAST_SECTIONS_SHARE * SECTIONS:
        return None
    breaks = np.linspace(arc[good][0], arc[good][-1], INTERVALS + 1)
    knots = np.concatenate([[breaks[0]] * DEGREE, breaks, [breaks[-1]] * DEGREE])
    if np.histogram(arc[good], breaks)[0].min() < DEGREE + 1:
        return None
    spline = make_lsq_spline(arc[good], middle[good], knots, DEGREE)
    design = BSpline.design_matrix(arc[good], knots, DEGREE).toarray()
    off = ((middle[good] - spline(arc[good])) * normal[good]).sum(axis=1)
    scatter = float(np.sqrt((off**2).sum() / (len(off) - design.shape[1])))
    fine = np.linspace(0.0, arc[-1], 8 * SECTIONS)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(spline(fine), axis=0), axis=1))])
    moved = BSpline(knots, spline.c + silhouette.corner, DEGREE)
    widths = np.interp(np.linspace(0.0, arc[-1], SECTIONS), arc[good], half_width[good])
    inverse = np.linalg.inv(design.T @ design)
    return CentreLine(moved, float(along[-1]), widths, scatter, fine, along, inverse)


def _edge(values: np.ndarray, threshold: float) -> np.ndarray:
    """Where each section (n, k) from the middle outwards falls half-way to what lies just beside the body there.

    A shadow on one side would otherwise move the edge; what lies beside is alike in neighbouring sections.
    """
    rough = _first_below(values, threshold)
    beside = np.nan_to_num(rough).astype(int)[:, None] + round(BESIDE_PX / SAMPLE_PX) + np.arange(5)
    outside = np.take_along_axis(values, np.minimum(beside, values.shape[1] - 1), -1).mean(axis=-1)
    outside = median_filter(np.minimum(outside, threshold), ALIKE_SECTIONS, mode="nearest")
    inside = median_filter(values.max(axis=-1), ALIKE_SECTIONS, mode="nearest")
    return _first_below(values, 0.5 * (inside + outside)[:, None])


def _inside(path: np.ndarray, mask: np.ndarray) -> np.ndarray:
    return np.clip(path, 0.0, np.array(mask.shape[::-1]) - 1.0)


def _sampled(silhouette: Silhouette, places: np.ndarray) -> np.ndarray:
    """How far the picture is from the ground at places (…, 2); beyond the part there is only ground."""
    flat = places.reshape(-1, 1, 2).astype(np.float32)
    values = cv2.remap(
        silhouette.step, flat[..., 0], flat[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT
    )
    return values.reshape(places.shape[:-1])


def _first_below(values: np.ndarray, threshold: float | np.ndarray) -> np.ndarray:
    """Where values along the last axis first fall below the threshold, between samples; NaN where they do not."""
    below = values < threshold
    index = np.argmax(below, axis=-1)
    found = below.any(axis=-1) & (index > 0)
    threshold = np.squeeze(np.broadcast_to(threshold, (*index.shape, 1)), -1)
    later = np.take_along_axis(values, index[..., None], -1)[..., 0]
    before = np.take_along_axis(values, np.maximum(index - 1, 0)[..., None], -1)[..., 0]
    drop = np.where(found, before - later, 1.0)
    return np.where(found, index - 1 + (before - threshold) / drop, np.nan)
