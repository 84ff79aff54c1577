"""Draw what the tracker found onto the picture."""

import cv2
import numpy as np

from hasel_tracker.tracking.bending_tracker import TrackedFrame

COLOURS = ((80, 200, 60), (40, 180, 255), (60, 60, 230))
LETTERS = ("H", "M", "T")
WHITE, SHADE = (255, 255, 255), (40, 40, 40)
PIXEL_FRACTION_BITS = 4


def annotate(image: np.ndarray, tracked: TrackedFrame, extra: str = "") -> np.ndarray:
    """A copy of the 8-bit BGR image with markers, the two lines between them, the angle and `extra` text."""
    drawn = image.copy()
    size = image.shape[1] / 1920.0
    thickness = max(round(2 * size), 1)
    positions = tracked.markers.positions
    for first, second in ((0, 1), (1, 2)):
        if np.isfinite(positions[[first, second]]).all():
            cv2.line(
                drawn, _fixed(positions[first]), _fixed(positions[second]), WHITE, thickness, cv2.LINE_AA,
                PIXEL_FRACTION_BITS,
            )  # fmt: skip
    for number in np.flatnonzero(tracked.markers.found):
        _mark(drawn, positions[number], number, float(tracked.markers.quality[number]), size, thickness)
    angle = f"sin = {tracked.sin_theta:+.4f}" if tracked.valid else "marker lost"
    _text(drawn, f"{tracked.time_s:8.3f} s   {angle}   {extra}", (30 * size, 60 * size), 1.3 * size)
    return drawn


def preview(image: np.ndarray, tracked: TrackedFrame, width_px: int) -> np.ndarray:
    """A small annotated picture, `width_px` wide."""
    scale = min(width_px / image.shape[1], 1.0)
    small = cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    markers = type(tracked.markers)((tracked.markers.positions + 0.5) * scale - 0.5, tracked.markers.quality)
    return annotate(small, TrackedFrame(tracked.time_s, markers, tracked.sin_theta, tracked.theta))


def _mark(
    drawn: np.ndarray, position: np.ndarray, number: int, quality: float, size: float, thickness: int
) -> None:
    radius = round(max(24 * size, 9) * 2**PIXEL_FRACTION_BITS)
    cv2.circle(drawn, _fixed(position), radius, COLOURS[number], thickness, cv2.LINE_AA, PIXEL_FRACTION_BITS)
    label = position + np.array([1.0, -1.0]) * max(30.0 * size, 18.0)
    _text(drawn, f"{LETTERS[number]} {quality:.2f}", label, 0.9 * size)


def _text(drawn: np.ndarray, text: str, corner: np.ndarray, scale: float) -> None:
    x, y = int(corner[0]), int(corner[1])
    scale, thickness = max(scale, 0.4), max(round(1.6 * scale), 1)
    (width, height), below = cv2.getTextSize(text, cv2.FONT_HERSHEY_SIMPLEX, scale, thickness)
    cv2.rectangle(drawn, (x - 4, y - height - 4), (x + width + 4, y + below + 2), SHADE, cv2.FILLED)
    cv2.putText(drawn, text, (x, y), cv2.FONT_HERSHEY_SIMPLEX, scale, WHITE, thickness, cv2.LINE_AA)


def _fixed(point: np.ndarray) -> tuple[int, int]:
    scaled = np.rint(point * 2**PIXEL_FRACTION_BITS).astype(int)
    return int(scaled[0]), int(scaled[1])
