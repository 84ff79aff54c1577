"""Whether a body runs from one dot to the next, and how wide it is.

A body is a band that differs from what lies on either side of it and is alike along itself. Colours along a bowed
path between the dots and those beside it are described by a normal distribution each, with a share of outliers
(electrodes, glints); the evidence is how much better the path's own description fits it than its surroundings' does,
in nats per sample, and must hold on every third of the way: a path that leaves the body half-way has none.
"""

from dataclasses import dataclass

import cv2
import numpy as np

STATIONS = 18
THIRDS = 3
STEP_SHARE = 0.006
LARGEST_BOW = 0.2
SHEARS = (-0.05, -0.025, 0.0, 0.025, 0.05)
PATHS_KEPT = 24
BESIDE_RADII = (2.5, 5.0)
BESIDE_SAMPLES = 3
LEAST_SPREAD = 3.0
OUTLIER_SHARE = 0.1
OUTLIER_DENSITY = np.log(OUTLIER_SHARE) - 3 * np.log(256.0)
LEAST_EVIDENCE = 5.0  # random grounds reach 4.8 in hundreds of trials, bodies have 6 and more
WIDEST_SHARE = 0.2


@dataclass(frozen=True)
class BodyLink:
    """Evidence of a body between two dots (least of the thirds) [nats per sample], and its width [px]."""

    evidence: float
    width_px: float

    @property
    def seen(self) -> bool:
        """Whether a body is there."""
        return self.evidence > LEAST_EVIDENCE


NO_LINK = BodyLink(-np.inf, 0.0)


def body_link(image: np.ndarray, first: np.ndarray, last: np.ndarray, radius_px: float) -> BodyLink:
    """Look for a body between the dots at `first` and `last` (2,) [px] of this radius, in an 8-bit BGR image."""
    along = last - first
    length = float(np.hypot(*along))
    if not length > 4.0 * radius_px:
        return NO_LINK
    across = np.array([-along[1], along[0]]) / length
    clear = min((1.6 * radius_px + 3.0) / length, 0.4)
    station = np.linspace(clear, 1.0 - clear, STATIONS)
    beside = [each * radius_px for each in BESIDE_RADII]
    reach = LARGEST_BOW * length + max(beside[-1] + 2.0 * radius_px, WIDEST_SHARE * length)
    step = max(STEP_SHARE * length, 1.0)
    offset = np.arange(-np.ceil(reach / step), np.ceil(reach / step) + 1) * step
    points = first + station[:, None, None] * along + offset[None, :, None] * across
    colours = cv2.remap(
        image, points[..., 0].astype(np.float32), points[..., 1].astype(np.float32), cv2.INTER_LINEAR
    ).astype(np.float32)  # (stations, offsets, 3)
    paths = _paths(station, length, step)
    best, best_at = NO_LINK, None
    candidates = paths
    for gap in beside:
        paths = _most_distinct(colours, candidates, len(offset) // 2, gap / step)
        evidence, models = _evidence(colours, paths, len(offset) // 2, gap / step, 2.0 * radius_px / step)
        number = int(np.argmax(evidence))
        if evidence[number] > best.evidence:
            best = BodyLink(float(evidence[number]), 0.0)
            best_at = paths[number], tuple(each[number] for each in models)
    if best_at is None:
        return NO_LINK
    return BodyLink(best.evidence, _width(colours, *best_at, len(offset) // 2) * step)


def _paths(station: np.ndarray, length: float, step: float) -> np.ndarray:
    """Offsets, in steps, of bowed and S-shaped paths at the stations, shape (paths, stations)."""
    bows = np.arange(-LARGEST_BOW * length, LARGEST_BOW * length + 1e-9, 1.5 * step) / step
    shears = np.array(SHEARS) * length / step
    bow, shear = (each.ravel()[:, None] for each in np.meshgrid(bows, shears))
    return bow * 4.0 * station * (1.0 - station) + shear * np.sin(2.0 * np.pi * station)


def _most_distinct(colours: np.ndarray, paths: np.ndarray, centre: int, gap: float) -> np.ndarray:
    """The paths that differ most from what is beside them, or are most alike along themselves."""
    rows, last = np.arange(STATIONS), colours.shape[1] - 1

    def at(offsets: np.ndarray) -> np.ndarray:
        return colours[rows, np.clip(np.rint(centre + offsets).astype(int), 0, last)]

    path = at(paths)
    beside = 0.5 * (at(paths - 1.5 * gap) + at(paths + 1.5 * gap))
    apart = np.minimum(np.abs(path - beside).sum(axis=2), 60.0).mean(axis=1)
    alike = np.minimum(np.abs(np.diff(path, axis=1)).sum(axis=2), 60.0).mean(axis=1)
    chosen = np.concatenate([np.argsort(-apart)[:PATHS_KEPT], np.argsort(alike - apart)[:PATHS_KEPT]])
    return paths[np.unique(chosen)]


def _evidence(
    colours: np.ndarray, paths: np.ndarray, centre: int, gap: float, band: float
) -> tuple[np.ndarray, tuple[np.ndarray, ...]]:
    """Least evidence of the thirds for each path, and the two descriptions (mean path, spread, beside, spread)."""
    rows = np.arange(STATIONS)
    last = colours.shape[1] - 1

    def at(offsets: np.ndarray) -> np.ndarray:
        return colours[rows, np.clip(np.rint(centre + offsets).astype(int), 0, last)]

    path = at(paths)  # (paths, stations, 3)
    away = np.linspace(gap, gap + band, BESIDE_SAMPLES)
    sides = np.stack([at(paths + sign * each) for sign in (-1, 1) for each in away])
    beside = np.median(sides, axis=0)  # per station: light and shadow change along the way
    rest = sides - beside
    outer_spread = _covariance(rest.transpose(1, 0, 2, 3).reshape(len(paths), -1, 3))
    trend = np.median(path, axis=1, keepdims=True)
    inner_spread = _covariance(path - trend)
    inner = _log_density(path - trend, inner_spread)
    outer = _log_density(path - beside, outer_spread)
    thirds = (inner - outer).reshape(len(paths), THIRDS, -1).mean(axis=2)
    return thirds.min(axis=1), (trend, inner_spread, beside, outer_spread)


def _covariance(rest: np.ndarray) -> np.ndarray:
    """Covariance (paths, 3, 3) of most of the colours (paths, samples, 3), with a floor for noise and coding."""
    size = np.abs(rest).sum(axis=2)
    share = int(0.8 * size.shape[1])
    kept = size <= np.partition(size, share, axis=1)[:, share, None]
    weighted = rest * (kept / kept.sum(axis=1, keepdims=True)).astype(np.float32)[..., None]
    spread = weighted.transpose(0, 2, 1) @ rest
    return 1.6 * spread + np.float32(LEAST_SPREAD**2) * np.eye(3, dtype=np.float32)


def _log_density(rest: np.ndarray, spread: np.ndarray) -> np.ndarray:
    """Log density of colours (paths, samples, 3) about zero, with a share of outliers."""
    distance = ((rest @ np.linalg.inv(spread)) * rest).sum(axis=2)
    usual = -0.5 * (distance + np.linalg.slogdet(spread)[1][:, None] + 3.0 * np.log(2.0 * np.pi))
    return np.logaddexp(usual, OUTLIER_DENSITY)


def _width(colours: np.ndarray, path: np.ndarray, models: tuple[np.ndarray, ...], centre: int) -> float:
    """Median over the stations of how many offsets about the path look like the body rather than what is beside."""
    trend, inner_spread, beside, outer_spread = models
    inner = _log_density((colours - trend).reshape(1, -1, 3), inner_spread[None])
    outer = _log_density((colours - beside[:, None]).reshape(1, -1, 3), outer_spread[None])
    body = (inner > outer).reshape(colours.shape[:2])
    widths = []
    for row, start in zip(body, np.rint(centre + path).astype(int), strict=True):
        if row[start]:
            gaps = np.flatnonzero(~row)
            right = gaps[gaps > start].min(initial=len(row))
            left = gaps[gaps < start].max(initial=-1)
            widths.append(right - left - 1)
    return float(np.median(widths)) if widths else 0.0
