# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a method says of one marker, the markers as one frame shows them, and the bending angle that they make."""

from dataclasses import dataclass, replace

import numpy as np
from hasel_recording.recording import turn_between

from hasel_tracker.tracking.doubt import Doubt

MARKER_NAMES = ("head", "middle", "tail")


@dataclass(frozen=True)
class MarkerMeasurement:
    """Centre (2,) [px], area [px²] and contrast to the background [grey levels] of a marker.

    noise: what is left unexplained, in the method's own terms. solidity: share of the marker that is seen whole, 0 to
    1. sigma_px: standard deviation of the centre, each way, that this explains. clarity: 1 for a clear marker, less
    for one in much noise.
    """

    centre: np.ndarray
    area: float
    contrast: float
    noise: float
    solidity: float
    sigma_px: float = float("nan")
    clarity: float = 1.0

    def moved_by(self, offset: np.ndarray) -> "MarkerMeasurement":
        """The same in pixels whose origin lies `offset` (2,) before."""
        return replace(self, centre=self.centre + offset)


def marker_names(count: int) -> tuple[str, ...]:
    """Names in order along the body: head, body_1 …, tail; of an odd number the one half-way is `middle`."""
    names = ["head", *(f"body_{number}" for number in range(1, count - 1)), "tail"]
    if count % 2 and count > 1:
        names[count // 2] = "middle"
    return tuple(names)


@dataclass(frozen=True)
class MarkerSet:
    """Positions (m, 2) [px], quality (m,) and standard deviation (m,) [px], if known, from head to tail.

    A lost marker is NaN with quality 0. doubt: why the whole set is not to be trusted though it is there; vouches_for:
    how many frames directly before, held in doubt, this one has shown to be right.
    """

    positions: np.ndarray
    quality: np.ndarray
    sigma_px: np.ndarray | None = None
    doubt: Doubt = Doubt.NONE
    vouches_for: int = 0

    @classmethod
    def lost(cls, count: int = 3, doubt: Doubt = Doubt.NONE) -> "MarkerSet":
        """No marker found."""
        return cls(np.full((count, 2), np.nan), np.zeros(count), np.full(count, np.nan), doubt)

    @property
    def found(self) -> np.ndarray:
        """Which markers have a position, shape (m,)."""
        return ~np.isnan(self.positions[:, 0])

    @property
    def names(self) -> tuple[str, ...]:
        """The markers' names in order."""
        return marker_names(len(self.positions))

    def __str__(self) -> str:
        words = [
            f"{name} ({x:.2f}, {y:.2f}) px" if found else f"{name} lost"
            for name, (x, y), found in zip(self.names, self.positions, self.found, strict=True)
        ]
        return ", ".join(words)


def head_middle_tail(points: np.ndarray) -> np.ndarray:
    """The three points (3, 2) that make the angle, of markers (m, 2) in order, m at least 3.

    The middle one is half-way along the row; of an even number it is half-way between the two in the middle.
    """
    points = np.asarray(points, dtype=float)
    inner = points[(len(points) - 1) // 2 : len(points) // 2 + 1].mean(axis=0)
    return np.stack([points[0], inner, points[-1]])


def bending_angle(
    points: np.ndarray, mirrored: bool = False, rest_direction_deg: float = 0.0
) -> tuple[float, float]:
    """Return (sin θ, θ [rad]) from the markers in image axes (x right, y down).

    `points` has shape (m, 2), from head to tail, in any one unit. With v_HM from head to middle and v_MT
    from middle to tail, sin θ = cross(v_HM, v_MT) / (|v_HM| |v_MT|), taken in axes with y up so that it is
    positive when the upper muscle contracts. Of two markers v_HM is where the straight body would point,
    anticlockwise from right. `mirrored` is for a camera that looks from below or over a mirror. Markers that
    coincide or are NaN give NaN.
    """
    points = np.asarray(points, dtype=float)
    if len(points) == 2:
        turn = np.radians(rest_direction_deg)
        front, rear = np.array([np.cos(turn), -np.sin(turn)]), points[1] - points[0]
    else:
        head, middle, tail = head_middle_tail(points)
        front, rear = middle - head, tail - middle
    axes = np.array([1.0, 1.0 if mirrored else -1.0])  # the image's y axis points down
    sine, angle = turn_between(front * axes, rear * axes)
    return float(sine), float(angle)
