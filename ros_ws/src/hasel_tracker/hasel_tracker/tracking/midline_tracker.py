# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Points along the centre line of a swimmer without dots, followed from frame to frame; says when that is in doubt."""

import numpy as np

from hasel_tracker.tracking.centre_line import CentreLine, centre_line
from hasel_tracker.tracking.doubt import Doubt, Trust
from hasel_tracker.tracking.head_order import CLEAR_RATIO, nearer_to, on_side
from hasel_tracker.tracking.marker_set import MarkerSet
from hasel_tracker.tracking.silhouette import find_silhouette
from hasel_tracker.tracking.tracker_settings import TrackerSettings, head_word

FORGET_AFTER_S = 1.0
LENGTH_TOLERANCE = 0.015
AREA_TOLERANCE = 0.05
SIZE_MEMORY = 0.02
NEARER_SHARE = 0.5
BY_THICKNESS = "the head is where the body is thicker"
ALIKE = "both halves of the body look alike: say where the head is with --head left, right or X,Y"
ENDS = np.array([0.0, 1.0])


class MidlineTracker:
    """Gives the places at `settings.shares` of the length of the one silhouette in view, head first."""

    def __init__(self, settings: TrackerSettings) -> None:
        self.settings = settings
        self.note = ""
        self._shares = np.array(settings.shares)
        self._size: np.ndarray | None = None
        self._size_known = False
        self._started_before = False
        self._longer_since_s: float | None = None
        self._forget()

    def _forget(self) -> None:
        self._ends: np.ndarray | None = None
        self._seen_at_s = -np.inf
        self._trust = Trust()
        self._how = ""

    def update(self, image: np.ndarray, time_s: float) -> MarkerSet:
        """Points in an 8-bit BGR image taken at `time_s`; nothing is carried over from an earlier frame."""
        if self._ends is not None and (time_s - self._seen_at_s > FORGET_AFTER_S or self._trust.broken):
            self._forget()
        search = find_silhouette(image, self.settings.body)
        if search.silhouette is None:
            return self._lost(search.note, search.doubt)
        line = centre_line(search.silhouette)
        if line is None:
            return self._lost("what stands out from the ground is no slender body with a clear centre line")
        first, how = self._head_first(line)
        if first is None:
            if self._ends is not None:
                self._trust.disagree()
            return self._lost(how, Doubt.AMBIGUOUS)
        self._how = how
        size = np.array([line.length_px, search.silhouette.area_px])
        doubt, vouched = self._judged(size, line.at(ENDS if first else ENDS[::-1]), time_s)
        shares = self._shares if first else 1.0 - self._shares
        quality = np.full(len(shares), np.exp(-(((size[0] / self._size[0] - 1.0) / LENGTH_TOLERANCE) ** 2)))
        return MarkerSet(line.at(shares), quality, line.sigma_at(shares), doubt, vouched)

    def _lost(self, note: str, doubt: Doubt = Doubt.NONE) -> MarkerSet:
        self.note = note
        self._longer_since_s = None
        self._trust.interrupt()
        return MarkerSet.lost(len(self._shares), doubt)

    def _head_first(self, line: CentreLine) -> tuple[bool | None, str]:
        """Whether the line starts at the head, and how that is known; None where it is not."""
        ends, head = line.at(ENDS), head_word(self.settings.head)
        if self._ends is not None:
            apart = [float(np.linalg.norm(each - self._ends)) for each in (ends, ends[::-1])]
            if min(apart) > NEARER_SHARE * max(apart):
                return None, "the swimmer turned too far between two frames to tell its ends apart"
            if self._how == BY_THICKNESS and _thicker_first(line) is (apart[0] > apart[1]):
                return None, "the thicker half is where the tail was"
            return apart[0] < apart[1], self._how
        if not self._started_before and not isinstance(head, str):
            return nearer_to(ends, head), "the head is at the end nearest to the point given"
        if not self._started_before and head != "auto":
            return on_side(ends, head), f"the head is on the {head}, as set"  # type: ignore[arg-type]
        thicker = _thicker_first(line)
        return thicker, ALIKE if thicker is None else BY_THICKNESS

    def _judged(self, size: np.ndarray, ends: np.ndarray, time_s: float) -> tuple[Doubt, int]:
        """The doubt about a centre line, and how many frames before it this one vouches for.

        A body keeps its length and its area. What covers a part of it makes it shorter for as long as it pleases;
        what is longer for a while was covered before, and counts from then on.
        """
        started = self._ends is not None
        change = np.zeros(2) if self._size is None else size / self._size - 1.0
        fits = bool((np.abs(change) <= [LENGTH_TOLERANCE, AREA_TOLERANCE]).all())
        if not fits and self._size_known:
            longer = bool(change[0] > LENGTH_TOLERANCE)
            self.note = f"the silhouette is {size[0]:.0f} px long where it was {self._size[0]:.0f} px"
            if not longer:
                self._longer_since_s = None
            elif self._longer_since_s is None:
                self._longer_since_s = time_s
            self._trust.interrupt()
            if not longer or time_s - self._longer_since_s < FORGET_AFTER_S:
                return Doubt.JUMP, 0
            self._size_known = False
        self._ends, self._seen_at_s = ends, time_s
        self.note = self._how
        self._longer_since_s = None
        if not fits or self._size is None or not started:
            self._size = self._size if fits and self._size is not None else size
            return self._trust.shake(self._trust.pending or Doubt.STARTING, recoverable=fits), 0
        doubt, vouched = self._trust.agree()
        if doubt is Doubt.NONE:
            self._size_known = self._started_before = True
            self._size = self._size + SIZE_MEMORY * (size - self._size)
        return doubt, vouched


def _thicker_first(line: CentreLine) -> bool | None:
    """Whether the body is thicker in the line's first half; None where both halves look alike."""
    half = len(line.half_width_px) // 2
    front, rear = line.half_width_px[:half].mean(), line.half_width_px[-half:].mean()
    return None if max(front, rear) < CLEAR_RATIO * min(front, rear) else bool(front > rear)
