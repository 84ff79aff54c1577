"""What lies around a marker: the background, its noise, the directions in which something crosses it."""

from dataclasses import dataclass

import numpy as np

DIRECTIONS = 48
FINE_SECTORS = 8 * DIRECTIONS
WIDENING = 2
MINIMUM_OPEN_SHARE = 0.3
REWEIGHTINGS = 4


@dataclass(frozen=True)
class MarkerSurroundings:
    """Background about `origin` (2,): plane (level, slopes in x and y), noise, crossed directions (48,)."""

    origin: np.ndarray
    plane: np.ndarray
    noise: float
    crossed: np.ndarray

    def level(self, shape: tuple[int, int]) -> np.ndarray:
        """Luma of the background on every pixel of a region of this shape."""
        x = np.arange(shape[1], dtype=np.float32) - self.origin[0]
        y = np.arange(shape[0], dtype=np.float32) - self.origin[1]
        across = (self.plane[0] + self.plane[1] * x).astype(np.float32)
        return across[None, :] + (self.plane[2] * y).astype(np.float32)[:, None]

    def open_window(self, symmetric: bool) -> np.ndarray | None:
        """Smooth weight by fine sector, zero where something crosses (or opposite, if `symmetric`).

        None when too few directions are left to locate the marker both ways.
        """
        closed = self.crossed
        if symmetric:
            closed = closed | np.roll(closed, DIRECTIONS // 2)
        closed = closed[_NEIGHBOURS].any(axis=1)
        if 1.0 - closed.mean() < MINIMUM_OPEN_SHARE:
            return None
        return ~closed @ _SMOOTHING


def _neighbours(reach: int) -> np.ndarray:
    return (np.arange(DIRECTIONS)[:, None] + np.arange(-reach, reach + 1)) % DIRECTIONS


def _smoothing() -> np.ndarray:
    """Matrix (DIRECTIONS, FINE_SECTORS) from open or closed directions to a smooth window."""
    direction = (np.arange(DIRECTIONS) + 0.5) / DIRECTIONS
    sector = (np.arange(FINE_SECTORS) + 0.5) / FINE_SECTORS
    apart = np.abs((direction[:, None] - sector[None, :] + 0.5) % 1.0 - 0.5) * DIRECTIONS
    weight = np.maximum(3.0 - apart, 0.0)
    return weight / weight.sum(axis=0)


_NEIGHBOURS = _neighbours(WIDENING)
_SMOOTHING = _smoothing()


def look_around(luma: np.ndarray, inside: np.ndarray, ring: np.ndarray) -> MarkerSurroundings:
    """Describe the background in `ring` around the marker that covers `inside` (masks of the same shape)."""
    rows, columns = np.nonzero(inside)
    origin = np.array([columns.mean(), rows.mean()])
    rows, columns = np.nonzero(ring)
    x, y, values = columns - origin[0], rows - origin[1], luma[rows, columns]
    direction = sector_of(x, y) // (FINE_SECTORS // DIRECTIONS)
    count = np.bincount(direction, minlength=DIRECTIONS)
    seen = count > 0
    share = 1.0 / np.maximum(count, 1)
    mean_x, mean_y, mean_value = (np.bincount(direction, each, DIRECTIONS) * share for each in (x, y, values))
    design = np.column_stack([np.ones(DIRECTIONS), mean_x, mean_y])
    plane, left, spread = _robust_plane(design, mean_value, seen)
    crossed = seen & (np.abs(left) > 4.0 * spread + 1.0)
    noise = spread / np.sqrt(middle_value(share[seen]))
    return MarkerSurroundings(origin, plane, float(noise), crossed)


def _robust_plane(
    design: np.ndarray, values: np.ndarray, seen: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """Plane through most of the sector means, what is left of each, and its typical size."""
    weight = seen.astype(float)
    for _ in range(REWEIGHTINGS):
        weighted = design * weight[:, None]
        plane = np.linalg.solve(weighted.T @ design + 1e-9 * np.eye(3), weighted.T @ values)
        left = values - design @ plane
        spread = 1.5 * middle_value(np.abs(left[seen])) + 0.1
        weight = seen / np.maximum(np.abs(left) / spread, 1.0) ** 2
    return plane, left, spread


def sector_of(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Number of the fine sector, counted from +x towards +y, in which an offset lies."""
    turn = np.arctan2(y, x) * (0.5 / np.pi)
    return np.floor(turn * FINE_SECTORS).astype(np.int64) % FINE_SECTORS


def middle_value(values: np.ndarray) -> float:
    """The median of a small array (the upper one of two), much faster than numpy's for these sizes."""
    half = len(values) // 2
    return float(np.partition(values, half)[half])
