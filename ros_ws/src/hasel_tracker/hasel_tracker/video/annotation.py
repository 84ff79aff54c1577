# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Draw what the tracker found onto the picture."""

from dataclasses import replace
from itertools import pairwise

import cv2
import numpy as np

from hasel_tracker.tracking.bending_tracker import TrackedFrame
from hasel_tracker.tracking.marker_set import MarkerSet

HEAD_COLOUR, BODY_COLOUR, TAIL_COLOUR = (80, 200, 60), (40, 180, 255), (60, 60, 230)
WHITE, SHADE = (255, 255, 255), (40, 40, 40)
PIXEL_FRACTION_BITS = 4


def annotate(image: np.ndarray, tracked: TrackedFrame, extra: str = "") -> np.ndarray:
    """A copy of the 8-bit BGR image with markers, the two lines between them, the angle and `extra` text."""
    drawn = image.copy()
    size = image.shape[1] / 1920.0
    thickness = max(round(2 * size), 1)
    positions = tracked.markers.positions
    for first, second in pairwise(positions):
        if np.isfinite([first, second]).all():
            cv2.line(
                drawn, _fixed(first), _fixed(second), WHITE, thickness, cv2.LINE_AA, PIXEL_FRACTION_BITS
            )  # fmt: skip
    for number in np.flatnonzero(tracked.markers.found):
        _mark(drawn, tracked.markers, number, size, thickness)
    doubt = tracked.markers.doubt
    why = f"in doubt: {doubt}" if doubt else "marker lost"
    angle = f"sin = {tracked.sin_theta:+.4f}" if tracked.valid else why
    _text(drawn, f"{tracked.time_s:8.3f} s   {angle}   {extra}", (30 * size, 60 * size), 1.3 * size)
    return drawn


def preview(image: np.ndarray, tracked: TrackedFrame, width_px: int) -> np.ndarray:
    """A small annotated picture, `width_px` wide."""
    scale = min(width_px / image.shape[1], 1.0)
    small = cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    markers = replace(tracked.markers, positions=(tracked.markers.positions + 0.5) * scale - 0.5)
    return annotate(small, replace(tracked, markers=markers))


def _mark(
    drawn: np.ndarray, markers: MarkerSet, number: int | np.integer, size: float, thickness: int
) -> None:
    position, quality = markers.positions[number], markers.quality[number]
    radius = round(max(24 * size, 9) * 2**PIXEL_FRACTION_BITS)
    last = len(markers.positions) - 1
    colour = {0: HEAD_COLOUR, last: TAIL_COLOUR}.get(int(number), BODY_COLOUR)
    cv2.circle(drawn, _fixed(position), radius, colour, thickness, cv2.LINE_AA, PIXEL_FRACTION_BITS)
    label = position + np.array([1.0, -1.0]) * max(30.0 * size, 18.0)
    name = markers.names[number]
    short = name.removeprefix("body_") if name.startswith("body_") else name[0].upper()
    _text(drawn, f"{short} {quality:.2f}", label, 0.9 * size)


def _text(drawn: np.ndarray, text: str, corner: np.ndarray | tuple[float, float], scale: float) -> None:
    x, y = int(corner[0]), int(corner[1])
    scale, thickness = max(scale, 0.4), max(round(1.6 * scale), 1)
    (width, height), below = cv2.getTextSize(text, cv2.FONT_HERSHEY_SIMPLEX, scale, thickness)
    cv2.rectangle(drawn, (x - 4, y - height - 4), (x + width + 4, y + below + 2), SHADE, cv2.FILLED)
    cv2.putText(drawn, text, (x, y), cv2.FONT_HERSHEY_SIMPLEX, scale, WHITE, thickness, cv2.LINE_AA)


def _fixed(point: np.ndarray) -> tuple[int, int]:
    scaled = np.rint(point * 2**PIXEL_FRACTION_BITS).astype(int)
    return int(scaled[0]), int(scaled[1])
