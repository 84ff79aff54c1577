# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Whether a body runs from one dot to the next, and how wide it is.

A body is a band that differs from what lies on either side of it and is alike along itself. Colours along a bowed
path between the dots and those beside it are described by a normal distribution each, with a share of outliers
(electrodes, glints); the evidence is how much better the path's own description fits it than its surroundings' does,
in nats per sample, and must hold on every third of the way: a path that leaves the body half-way has none.
"""

from dataclasses import dataclass, field

import cv2
import numpy as np

from hasel_tracker.tracking.body_colours import StraightView, covariance, log_densities, log_density

STATIONS = 18
THIRDS = 3
STEP_SHARE = 0.006
LARGEST_BOW = 0.2
SHEARS = (-0.05, -0.025, 0.0, 0.025, 0.05)
PATHS_KEPT = 24
REFINED_STEPS = 4
BESIDE_RADII = (2.5, 5.0)
BESIDE_SAMPLES = 3
LEAST_EVIDENCE = 5.0  # random grounds reach 4.8 in hundreds of trials, bodies have 6 and more
WIDEST_SHARE = 0.2
SKIN_RADII = 0.7
LEAST_CONTRAST = 5.0
CLEAR_OF_RIM = 2.5


@dataclass(frozen=True)
class BodyLink:
    """Evidence of a body between two dots (least of the thirds) [nats per sample], its width [px] (NaN if it cannot be
    told), and the views in which it is seen."""

    evidence: float
    width_px: float
    views: tuple[StraightView, ...] = field(default=(), repr=False, compare=False)

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
    # Beyond the picture's edge it is taken to go on as at the edge: black would be a contrast of its own.
    colours = cv2.remap(
        image, points[..., 0].astype(np.float32), points[..., 1].astype(np.float32), cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
    ).astype(np.float32)  # (stations, offsets, 3)  # fmt: skip
    candidates, centre, band = _paths(station, length, step), len(offset) // 2, 2.0 * radius_px / step
    most, width, seen_along = -np.inf, 0.0, []
    for gap in beside:
        paths = _most_distinct(colours, candidates, centre, gap / step)
        evidence, models = _evidence(colours, paths, centre, gap / step, band)
        number = int(np.argmax(evidence))
        smooth, straight = paths[number], np.abs(paths).max(axis=1)
        likely = np.flatnonzero(evidence > LEAST_EVIDENCE)
        if likely.size:
            straightest = likely[straight[likely].argmin()]
            seen_along.append((paths[straightest], tuple(each[straightest] for each in models)))
        near = _refined(colours, paths[number], tuple(each[number] for each in models), centre)
        paths = np.stack([paths[number], near])
        evidence, models = _evidence(colours, paths, centre, gap / step, band)
        number = int(np.argmax(evidence))
        most = max(most, float(evidence[number]))
        # The widest gap at which a body is seen: a nearer one may see no more than a spine within it.
        if evidence[number] > LEAST_EVIDENCE:
            seen_along.append((paths[number], tuple(each[number] for each in models)))
            skin = max(round(SKIN_RADII * radius_px / step), 1)
            width = _width(colours, smooth, models[2][number], centre, skin) * step
    views = [
        StraightView(
            first, along / length, across, length, station * length, step, colours, path * step, described
        )
        for path, described in seen_along
    ]
    return BodyLink(most, width, tuple(views))


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


def _refined(
    colours: np.ndarray, path: np.ndarray, models: tuple[np.ndarray, ...], centre: int
) -> np.ndarray:
    """The smooth path within a few steps of `path` (stations,) that looks most like the body."""
    inner, outer = log_densities(colours, models)
    reach = np.arange(-REFINED_STEPS, REFINED_STEPS + 1)
    places = np.clip(np.rint(centre + path).astype(int)[:, None] + reach, 0, colours.shape[1] - 1)
    gain = np.take_along_axis((inner - outer).reshape(colours.shape[:2]), places, axis=1)
    total, came = gain[0], []
    for row in gain[1:]:
        padded = np.pad(total, 1, constant_values=-np.inf)
        choices = np.stack([padded[:-2], padded[1:-1], padded[2:]])
        came.append(choices.argmax(axis=0) - 1)
        total = choices.max(axis=0) + row
    chosen = [int(total.argmax())]
    for back in reversed(came):
        chosen.append(chosen[-1] + int(back[chosen[-1]]))
    return places[np.arange(STATIONS), chosen[::-1]].astype(float) - centre


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
    outer_spread = covariance(rest.transpose(1, 0, 2, 3).reshape(len(paths), -1, 3))
    trend = np.median(path, axis=1, keepdims=True)
    inner_spread = covariance(path - trend)
    inner = log_density(path - trend, inner_spread)
    outer = log_density(path - beside, outer_spread)
    thirds = (inner - outer).reshape(len(paths), THIRDS, -1).mean(axis=2)
    return thirds.min(axis=1), (trend, inner_spread, beside, outer_spread)


def _width(colours: np.ndarray, path: np.ndarray, beside: np.ndarray, centre: int, skin: int) -> float:
    """Width of the body in steps: where the profile across it falls to half of what it is beside the spine.

    The profile is the median along the way, so that noise, glints and grains of the ground largely cancel; `skin` steps
    from the path lies the skin rather than a spine. A shadow lies the other way from the background than a bright
    body, and is not counted. NaN where the profile does not stand out.
    """
    places = np.rint(centre + path).astype(int)
    half = min(places.min(), colours.shape[1] - 1 - places.max())
    reach = np.arange(-half, half + 1)
    across = colours[np.arange(STATIONS)[:, None], places[:, None] + reach] - beside[:, None]
    profile = np.median(across, axis=0)
    rim = max(half // 4, 2)
    # Light that falls from one side to the other is no body.
    left_rim, right_rim = np.median(profile[:rim], axis=0), np.median(profile[-rim:], axis=0)
    profile = (
        profile
        - 0.5 * (left_rim + right_rim)
        - (reach / (2.0 * half - rim))[:, None] * (right_rim - left_rim)
    )
    skin_colour = 0.5 * (profile[half - skin] + profile[half + skin])
    contrast = float(np.linalg.norm(skin_colour))
    rest = np.median(np.linalg.norm(np.concatenate([profile[:rim], profile[-rim:]]), axis=1))
    if contrast < max(LEAST_CONTRAST, CLEAR_OF_RIM * rest):
        return 2.0 * skin if contrast < LEAST_CONTRAST else float("nan")
    share = profile @ skin_colour / contrast**2
    share[half - skin : half + skin + 1] = 1.0
    # What is no wider than a dot's radius, such as a spine beside the path, does not end the body.
    gap = 1 + round(skin / SKIN_RADII)
    body = np.convolve(share >= 0.5, np.ones(gap + 1), mode="full")
    right = np.flatnonzero(body[half + gap :] < 0.5)
    left = np.flatnonzero(body[: half + 1][::-1] < 0.5)
    return float((right[0] if right.size else half + 1) + (left[0] if left.size else half + 1) - 1)
