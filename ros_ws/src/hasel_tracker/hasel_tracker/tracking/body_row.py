# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Whether dots between which a body is seen are where its markers must be: on its axis, out to its ends, and on a body
beside which no other of its shade lies."""

from collections.abc import Iterator

import numpy as np

from hasel_tracker.tracking.body_axis import AxisAtDot, OwnBand, axis_at, goes_on, own_band
from hasel_tracker.tracking.body_colours import StraightView
from hasel_tracker.tracking.body_link import BodyLink

END_SHARE = 8  # the outer markers lie within an eighth of the row's length of the body's ends
CROWDED_SHARE = 3
SHARPEST_CORNER = np.cos(np.deg2rad(30.0))  # of the axis in a dot; a body bends by less within a few radii
CLEAR_OF_DOT_RADII, CLEAR_OF_DOT_PX = 1.6, 3.0

OFF_AXIS = "a dot does not lie on the middle of the body between the others, so that it may be no marker"
GOES_ON = "the body goes on beyond the outermost dot, so that a marker may be out of sight there"
CROWDED = "more of the body's shade lies beside it, so that it cannot be told from another"


def crowd(links: tuple[BodyLink, ...], radius_px: float) -> str:
    """CROWDED where, along a third of a link, something of the body's shade lies beside the body; else empty."""
    for link in links:
        if link.views and all(_is_crowded(view, radius_px) for view in link.views):
            return CROWDED
    return ""


def misfit(image: np.ndarray, positions: np.ndarray, links: tuple[BodyLink, ...], radius_px: float) -> str:
    """Why dots at `positions` (m, 2) [px] with these m - 1 links between them may not be a body's markers; or empty."""
    span = float(np.linalg.norm(np.diff(positions, axis=0), axis=1).sum())
    near = CLEAR_OF_DOT_RADII * radius_px + CLEAR_OF_DOT_PX
    far = max(span / END_SHARE, near + radius_px)
    bodies = [_Bodies(link, radius_px) for link in links]
    for number, dot in enumerate(positions):
        beside = [each.through(dot) for each in bodies[max(number - 1, 0) : number + 1]]
        first = [next(each, None) for each in beside]
        if None in first:
            return OFF_AXIS
        if len(first) == 1:
            view, axis = first[0]
            if goes_on(image, view, _is_at_first(view, dot), axis.outward, near, far):
                return GOES_ON
        else:
            before, after = ([start, *rest] for start, rest in zip(first, beside, strict=True))
            if not any(
                -one.outward @ other.outward > SHARPEST_CORNER for _, one in before for _, other in after
            ):
                return OFF_AXIS
    return ""


class _Bodies:
    """What may be the body between two dots, looked at one after the other."""

    def __init__(self, link: BodyLink, radius_px: float) -> None:
        self._views, self._radius_px = link.views, radius_px
        self._bands: dict[int, OwnBand] = {}

    def through(self, dot: np.ndarray) -> Iterator[tuple[StraightView, AxisAtDot]]:
        """Those whose axis leads through this one of the two dots."""
        for number, view in enumerate(self._views):
            if number not in self._bands:
                self._bands[number] = own_band(view, self._radius_px)
            axis = axis_at(view, self._bands[number], self._radius_px, _is_at_first(view, dot))
            if axis.on_axis:
                yield view, axis


def _is_crowded(view: StraightView, radius_px: float) -> bool:
    crowded = own_band(view, radius_px).crowded
    return bool(CROWDED_SHARE * crowded.sum() > len(crowded))


def _is_at_first(view: StraightView, dot: np.ndarray) -> bool:
    return bool(np.linalg.norm(view.first - dot) < np.linalg.norm(view.last - dot))
