# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Which end of a row is the head: what the user says, the body's thickness or the markers' distances tell."""

import numpy as np

from hasel_tracker.tracking.body_link import BodyLink
from hasel_tracker.tracking.marker_row import MarkerRow
from hasel_tracker.tracking.tracker_settings import head_word

CLEAR_CHORD_RATIO = 1.2
LOOK_ALIKE = "both halves of the body look alike: say where the head is with --head left, right or X,Y"
CLEAR_RATIO = 1.5


class HeadOrder:
    """What the user says holds for the first row alone; later rows may lie any way round.

    chords_px: (m - 1,) distances from marker to marker, head first: in any unit if said, then those that are seen once
    the markers are known for certain.
    """

    def __init__(self, head: str, chords_px: np.ndarray | None = None) -> None:
        self._said = head_word(head)
        self._known = False
        self._chords_px = chords_px

    def learn(self, chords_px: np.ndarray | None = None) -> None:
        """The head is known now, and the distances if given."""
        self._known = True
        self._chords_px = self._chords_px if chords_px is None else chords_px

    def sort(self, row: MarkerRow) -> tuple[MarkerRow | None, str]:
        """The row with its head first, and how that is known; None where it is not."""
        first, how = self._head_first(row)
        if first is None:
            return None, how
        return (row if first else row.reversed()), how

    def _head_first(self, row: MarkerRow) -> tuple[bool | None, str]:
        centres = row.centres
        if not self._known and not isinstance(self._said, str):
            return nearer_to(centres, self._said), "the head is at the end nearest to the point given"
        if not self._known and self._said != "auto":
            return on_side(centres, str(self._said)), f"the head is on the {self._said}, as set"
        thicker = thicker_first(row.links)
        if thicker is not None:
            return thicker, "the head is where the body is thicker"
        by_layout = self._first_by_layout(centres)
        if by_layout is not None:
            return by_layout, "the head is told by the markers' distances"
        return None, LOOK_ALIKE

    def _first_by_layout(self, centres: np.ndarray) -> bool | None:
        """Whether the distances between the markers are those known from before, if they tell the ends apart."""
        if self._chords_px is None or len(self._chords_px) < 2:
            return None
        layout = np.log(self._chords_px)
        if np.abs(layout - layout[::-1]).max() < np.log(CLEAR_CHORD_RATIO):
            return None
        chords = np.log(np.linalg.norm(np.diff(centres, axis=0), axis=1))
        apart = [np.linalg.norm(np.ptp(each - layout)) for each in (chords, chords[::-1])]
        return bool(apart[0] < apart[1])


def as_before(row: MarkerRow, last_seen: np.ndarray) -> MarkerRow:
    """The row in the order in which it is nearer to where the markers were, (m, 2) [px]."""
    apart = [np.linalg.norm(each - last_seen) for each in (row.centres, row.centres[::-1])]
    return row if apart[0] < apart[1] else row.reversed()


def on_side(row: np.ndarray, side: str) -> bool:
    """Whether the first point of `row` (m, 2) [px] is the one on this side of the picture."""
    axis = 0 if side in ("left", "right") else 1
    return bool((row[0, axis] <= row[-1, axis]) == (side in ("left", "top")))


def nearer_to(row: np.ndarray, point: np.ndarray) -> bool:
    """Whether the first point of `row` (m, 2) [px] is nearer to `point` (2,) than the last."""
    return bool(np.linalg.norm(row[0] - point) < np.linalg.norm(row[-1] - point))


def thicker_first(links: tuple[BodyLink, ...]) -> bool | None:
    """Whether the body is thicker towards the first end of the row; None where both halves look alike."""
    if len(links) < 2:
        return None
    place = np.linspace(-1.0, 1.0, len(links))
    widths = np.array([link.width_px for link in links])
    slope = float(place @ widths / (place @ place))
    front, rear = widths.mean() - slope, widths.mean() + slope  # of a line through all
    if not (min(front, rear) > 0.0 and max(front, rear) > CLEAR_RATIO * min(front, rear)):
        return None
    return bool(front > rear)
