"""Whether dots between which a body is seen are where its markers must be: on its axis, out to its ends, and on a body
beside which no other of its shade lies."""

import numpy as np

from hasel_tracker.tracking.body_axis import axis_at, goes_on, own_band
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
    for number, dot in enumerate(positions):
        outward = []
        for link in links[max(number - 1, 0) : number + 1]:
            fitting = [
                (view, at_first, axis)
                for view in link.views
                for at_first in [_is_at_first(view, dot)]
                for axis in [axis_at(view, radius_px, at_first)]
                if axis.on_axis
            ]
            if not fitting:
                return OFF_AXIS
            if number in (0, len(positions) - 1) and any(
                goes_on(image, view, at_first, axis.outward, near, far) for view, at_first, axis in fitting
            ):
                return GOES_ON
            outward.append([axis.outward for _, _, axis in fitting])
        if len(outward) == 2 and not any(
            -before @ after > SHARPEST_CORNER for before in outward[0] for after in outward[1]
        ):
            return OFF_AXIS
    return ""


def _is_crowded(view: StraightView, radius_px: float) -> bool:
    crowded = own_band(view, radius_px).crowded
    return bool(CROWDED_SHARE * crowded.sum() > len(crowded))


def _is_at_first(view: StraightView, dot: np.ndarray) -> bool:
    return bool(np.linalg.norm(view.first - dot) < np.linalg.norm(view.last - dot))
