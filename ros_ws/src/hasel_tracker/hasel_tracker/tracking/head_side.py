"""Which end of the row is the head: the body is thicker in front of the middle marker than behind it."""

import cv2
import numpy as np

STATIONS = np.linspace(0.3, 0.7, 9)
PROFILE_SAMPLES = 121
PROFILE_REACH = 0.1
CLEAR_RATIO = 1.3
DIFFERENT = 12.0


def starts_at_head(image: np.ndarray, row: np.ndarray, head: str) -> tuple[bool, str]:
    """Whether the first point of `row` (3, 2) [px] is the head, and a sentence that says why.

    `head` is `auto` or the side of the picture on which the head is.
    """
    if head != "auto":
        return _on_side(row, head), f"the head is on the {head}, as set"
    first, last = (_thickness(image, row[1], end, row) for end in (row[0], row[2]))
    if min(first, last) >= 0.0 and max(first, last) > CLEAR_RATIO * max(min(first, last), 1.0):
        return first > last, "the head is where the body is thicker"
    return _on_side(row, "left"), "both halves look alike, so the left end is taken for the head"


def _on_side(row: np.ndarray, side: str) -> bool:
    axis = 0 if side in ("left", "right") else 1
    first_is_smaller = row[0, axis] <= row[2, axis]
    return bool(first_is_smaller == (side in ("left", "top")))


def _thickness(image: np.ndarray, middle: np.ndarray, end: np.ndarray, row: np.ndarray) -> float:
    """Median width [px] of what differs from the background across the half from `middle` to `end`."""
    along = end - middle
    across = np.array([-along[1], along[0]]) / np.hypot(*along)
    # A parabola through the three markers: the half bows away from its chord.
    other = row[0] if np.allclose(end, row[2]) else row[2]
    bow = 0.5 * (end + other) - middle
    reach = PROFILE_REACH * np.linalg.norm(np.diff(row, axis=0), axis=1).sum()
    offsets = np.linspace(-reach, reach, PROFILE_SAMPLES)
    widths = []
    for station in STATIONS:
        centre = middle + station * along - station * (1.0 - station) * bow
        points = (centre + offsets[:, None] * across).astype(np.float32)
        profile = cv2.remap(image, points[None, :, 0], points[None, :, 1], cv2.INTER_LINEAR)[0].astype(float)
        widths.append(_width_about_centre(profile) * (offsets[1] - offsets[0]))
    return float(np.median(widths))


def _width_about_centre(profile: np.ndarray) -> float:
    outer = np.concatenate([profile[:20], profile[-20:]])
    difference = np.linalg.norm(profile - np.median(outer, axis=0), axis=1)
    return float((difference > DIFFERENT + 2.0 * np.median(outer.std(axis=0))).sum())
