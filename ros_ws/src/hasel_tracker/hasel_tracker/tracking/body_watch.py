# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Look from time to time whether the body still leads from marker to marker, head first."""

import numpy as np

from hasel_tracker.tracking.body_link import BodyLink
from hasel_tracker.tracking.body_row import misfit
from hasel_tracker.tracking.head_order import thicker_first
from hasel_tracker.tracking.marker_search import links_at

LINK_PERIOD_S = 0.25


class BodyWatch:
    """seen: whether a body is seen at all; where it is not (markers pointed at on a textured ground) none is asked
    for. links: those of the start. whole: whether the markers are known to lie on the body's axis out to its ends."""

    def __init__(self, links: tuple[BodyLink, ...], time_s: float, whole: bool = True) -> None:
        self.seen = all(link.seen for link in links)
        self._by_thickness = thicker_first(links) is True
        self._looked_at_s = time_s
        self._whole = whole

    def due(self, time_s: float) -> bool:
        """Whether it is time to look again."""
        return time_s - self._looked_at_s > LINK_PERIOD_S

    def agrees(self, image: np.ndarray, positions: np.ndarray, radius_px: float, time_s: float) -> bool:
        """Whether the body leads along markers (m, 2) [px], through them and out to its ends, and is not thicker at the
        tail, if it was not before."""
        if not self.seen:
            return True
        links = links_at(image, positions, range(len(positions) - 1), radius_px)
        turned = self._by_thickness and thicker_first(links) is False
        if turned or not all(link.seen for link in links):
            return False
        if self._whole and misfit(image, positions, links, radius_px):
            return False
        self._looked_at_s = time_s
        return True
