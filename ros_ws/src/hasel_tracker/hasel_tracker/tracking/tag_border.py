"""The corners of a tag from its black border: a straight line through the half-level edge of each side."""

from dataclasses import dataclass

import cv2
import numpy as np

POINTS = 32
STEP_PX = 0.25
BORDER_CELLS = 8  # black border included; the border is one cell wide, and so is the white rim
LEAST_POINTS = 8
REWEIGHTINGS = 4
CORRELATED_PX = 2.0
ROUGH_SHARE = 0.01


@dataclass(frozen=True)
class _Side:
    """A line: a point on it (2,), its direction (2,), and the standard deviation of its place [px]."""

    point: np.ndarray
    along: np.ndarray
    sigma_px: float


def border_corners(grey: np.ndarray, corners: np.ndarray) -> tuple[np.ndarray, float]:
    """Corners (4, 2) [px] of a tag in an 8-bit grey image, from rough ones in clockwise order, and the standard
    deviation of their mean, each way [px]; the rough ones where a side is not clear."""
    sides = [_side(grey, corners[n], corners[(n + 1) % 4]) for n in range(4)]
    if all(sides):
        found = np.array([_crossing(sides[n - 1], sides[n]) for n in range(4)])
        if np.linalg.norm(found - corners, axis=1).max() < _length(corners) / BORDER_CELLS:
            # Two opposite sides fix each direction.
            return found, float(np.sqrt(np.mean([side.sigma_px**2 for side in sides]) / 2.0))
    return corners, ROUGH_SHARE * _length(corners)


def _length(corners: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(corners, axis=0, append=corners[:1]), axis=1).mean())


def _side(grey: np.ndarray, first: np.ndarray, last: np.ndarray) -> _Side | None:
    """The side between two rough corners (2,), or None where too little of the edge is seen."""
    length = float(np.linalg.norm(last - first))
    along = (last - first) / length
    across = np.array([along[1], -along[0]])  # outwards, as corners go clockwise in the picture
    share = np.linspace(0.1, 0.9, POINTS)[:, None]
    reach = 0.6 * length / BORDER_CELLS
    offset = np.arange(-reach, reach + 1e-9, STEP_PX)
    points = first + share[..., None] * length * along + offset[None, :, None] * across
    levels = cv2.remap(
        grey, points[..., 0].astype(np.float32), points[..., 1].astype(np.float32), cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
    ).astype(float)  # fmt: skip
    half = 0.5 * (levels.min(axis=1) + levels.max(axis=1))
    above = levels - half[:, None]
    rises = (above[:, :-1] < 0.0) & (above[:, 1:] >= 0.0)
    clear = (rises.sum(axis=1) == 1) & (np.ptp(levels, axis=1) > 0.5 * np.median(np.ptp(levels, axis=1)))
    if clear.sum() < LEAST_POINTS:
        return None
    rows = np.flatnonzero(clear)
    column = rises[rows].argmax(axis=1)
    before, after = above[rows, column], above[rows, column + 1]
    edge = offset[column] + STEP_PX * before / (before - after)
    place = share[rows, 0] * length
    slope, level, spread = _line(place, edge)
    independent = 0.8 * clear.mean() * length / CORRELATED_PX
    return _Side(first + level * across, along + slope * across, spread / np.sqrt(max(independent, 1.0)))


def _line(place: np.ndarray, edge: np.ndarray) -> tuple[float, float, float]:
    """Slope, level and scatter of a line, robust against stretches where something lies over the edge."""
    weight = np.ones(len(place))
    for _ in range(REWEIGHTINGS):
        slope, level = np.polyfit(place, edge, 1, w=weight)
        left = np.abs(edge - level - slope * place)
        spread = 1.48 * np.median(left) + 0.02
        weight = np.maximum(1.0 - (left / (4.0 * spread)) ** 2, 0.0)
    return float(slope), float(level), float(spread)


def _crossing(one: _Side, other: _Side) -> np.ndarray:
    share = np.linalg.solve(np.column_stack([one.along, -other.along]), other.point - one.point)
    return one.point + share[0] * one.along
