# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where the body's own axis runs between two dots, whether it leads through them, and whether the body ends there."""

from dataclasses import dataclass
from itertools import combinations

import cv2
import numpy as np

from hasel_tracker.tracking.body_colours import OUTLIER_DENSITY, StraightView, log_densities

LEAST_GAIN = 1.0  # nats: what is alike to both, such as a shadow, is no body
SMOOTH_PX = 3.0
LARGEST_HOLE_RADII = 1.5
NEAR_STATIONS = 9
LEAST_STATIONS = 6
CLEARLY_MORE = 2
RINGS = 12
MISSING_RINGS = 1
FAN_RAD = np.deg2rad(np.arange(-75.0, 75.1, 6.0))
ON_AXIS_RADII, LEAST_TOLERANCE_PX = 0.25, 1.5
STRAIGHT_RADII = 4.0
TRIPLES = np.array(list(combinations(range(NEAR_STATIONS + 1), 3)))


@dataclass(frozen=True)
class OwnBand:
    """Both edges of the body at each station [px], NaN where none is seen; crowded: where more of its shade is."""

    low_px: np.ndarray
    high_px: np.ndarray
    crowded: np.ndarray

    @property
    def middle_px(self) -> np.ndarray:
        """The body's middle at each station [px]."""
        return 0.5 * (self.low_px + self.high_px)


def own_band(view: StraightView, radius_px: float) -> OwnBand:
    """The body about the view's path, as far as there is no ground.

    What is neither body nor ground is part of it where it lies within, such as an electrode, and not at its rim, such
    as a shadow.
    """
    shape, smooth = view.colours.shape[:2], (max(round(SMOOTH_PX / view.step_px), 1), 1)
    count, centre = shape[1], shape[1] // 2
    body, ground = (
        cv2.blur(each.reshape(shape), smooth) > LEAST_GAIN for each in _likeness(view.colours, view.models)
    )
    path = np.rint(centre + view.path_px / view.step_px)
    edges, crowded = np.full((2, shape[0]), np.nan), np.zeros(shape[0], bool)
    for number, on_path in enumerate(path):
        places = np.flatnonzero(body[number])
        near = places[np.abs(places - on_path).argmin()] if places.size else -count
        if abs(near - on_path) * view.step_px > LARGEST_HOLE_RADII * radius_px:
            continue
        free = np.flatnonzero(ground[number] & ~body[number])
        low, high = free[free < near].max(initial=-1), free[free > near].min(initial=count)
        own = (places > low) & (places < high)
        first, last = places[own][[0, -1]]
        edges[:, number] = (first - centre) * view.step_px, (last - centre) * view.step_px
        beside = places[~own]
        runs = np.split(beside, np.flatnonzero(np.diff(beside) > 1) + 1)
        longest_px = max(len(run) for run in runs) * view.step_px
        crowded[number] = longest_px > radius_px or first == 0 or last == count - 1
    return OwnBand(edges[0], edges[1], crowded)


@dataclass(frozen=True)
class AxisAtDot:
    """any_axis, through: at how many of the stations nearest to a dot the body's middle lies on one smooth axis, and on
    one that leads through the dot; outward: where that leads from the body on (2,)."""

    any_axis: int
    through: int
    outward: np.ndarray

    @property
    def on_axis(self) -> bool:
        """Whether the dot lies on the body's axis."""
        return self.through >= LEAST_STATIONS and self.any_axis - self.through < CLEARLY_MORE


def axis_at(view: StraightView, band: OwnBand, radius_px: float, at_first: bool) -> AxisAtDot:
    """The body's axis at the dot at this end of the view, of which `band` is the body.

    Something over the body hides its middle at some stations; an axis is a parabola through three of them, or through
    two and the dot, and one that comes within a radius of the dot leads through it.
    """
    middle = band.middle_px
    inward = view.station_px if at_first else view.length_px - view.station_px
    nearest = np.argsort(inward)[:NEAR_STATIONS]
    inward, middle = np.append(inward[nearest], 0.0), np.append(middle[nearest], 0.0)
    curves = np.linalg.solve(np.vander(inward, 3)[TRIPLES], middle[TRIPLES][..., None])[..., 0]
    with np.errstate(invalid="ignore"):
        miss = np.abs(curves @ np.vander(inward[:-1], 3).T - middle[:-1])
        through = np.abs(curves[:, 2]) <= radius_px
    tolerance = max(ON_AXIS_RADII * radius_px, LEAST_TOLERANCE_PX)
    votes = (miss < tolerance).sum(axis=1)
    any_axis = votes[(TRIPLES < NEAR_STATIONS).all(axis=1)].max()
    best = int(np.argmax(np.where(through, votes, -1)))
    agreeing = np.flatnonzero(miss[best] < tolerance)
    slope = 0.0
    if agreeing.size >= LEAST_STATIONS:
        # Over a few pixels a parabola's slope is noise, and a body is straight.
        degree = 2 if np.ptp(inward[agreeing]) > STRAIGHT_RADII * radius_px else 1
        slope = float(np.polyfit(inward[agreeing], middle[agreeing], degree)[-2])
    along = -view.along if at_first else view.along
    outward = along - slope * view.across
    return AxisAtDot(int(any_axis), int(votes[best] * through[best]), outward / np.hypot(*outward))


def goes_on(
    image: np.ndarray, view: StraightView, at_first: bool, outward: np.ndarray, near_px: float, far_px: float
) -> bool:
    """Whether the body is seen to go on from the dot at this end, from `near_px` to `far_px` away from it."""
    dot = view.first if at_first else view.last
    away = np.linspace(near_px, far_px, RINGS)
    turn = np.arctan2(outward[1], outward[0]) + FAN_RAD
    points = dot + away[:, None, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    colours = cv2.remap(
        image, points[..., 0].astype(np.float32), points[..., 1].astype(np.float32), cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
    ).astype(np.float32)  # fmt: skip
    trend, spread, beside, beside_spread = view.models
    last = beside[:3] if at_first else beside[-3:]
    ground = np.broadcast_to(last.mean(axis=0), (RINGS, 3))
    like_body, _ = _likeness(colours, (trend, spread, ground, beside_spread))
    body = cv2.blur(like_body, (1, 3)) > LEAST_GAIN
    reached, missing = body[0], 0
    for ring in body[1:]:
        wider = np.convolve(reached, np.ones(3), mode="same") > 0.0
        missing = 0 if (wider & ring).any() else missing + 1
        if missing > MISSING_RINGS:
            return False
        reached = wider & ring if not missing else wider
    return bool(reached.any()) and not missing


def _likeness(colours: np.ndarray, models: tuple[np.ndarray, ...]) -> tuple[np.ndarray, np.ndarray]:
    """How much more the colours (stations, offsets, 3) look like the body than like what is beside it, and like that
    than like anything else [nats]."""
    inner, outer = (each.reshape(colours.shape[:2]) for each in log_densities(colours, models))
    return inner - outer, outer - OUTLIER_DENSITY
