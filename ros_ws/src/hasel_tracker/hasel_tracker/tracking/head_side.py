"""Which end of the row is the head: what the user says, or the end before which the body is clearly thicker."""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from hasel_tracker.tracking.body_link import BodyLink

CLEAR_RATIO = 1.5
SIDES = ("left", "right", "top", "bottom")


def on_side(row: np.ndarray, side: str) -> bool:
    """Whether the first point of `row` (m, 2) [px] is the one on this side of the picture."""
    axis = 0 if side in ("left", "right") else 1
    return bool((row[0, axis] <= row[-1, axis]) == (side in ("left", "top")))


def nearer_to(row: np.ndarray, point: np.ndarray) -> bool:
    """Whether the first point of `row` (m, 2) [px] is nearer to `point` (2,) than the last."""
    return bool(np.linalg.norm(row[0] - point) < np.linalg.norm(row[-1] - point))


def thicker_first(links: "tuple[BodyLink, ...]") -> bool | None:
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


def head_word(head: str) -> np.ndarray | str:
    """`auto`, a side, or the point (2,) that 'X,Y' names; raises ValueError for anything else."""
    if head == "auto" or head in SIDES:
        return head
    x, _, y = head.partition(",")
    return np.array([float(x), float(y)])
