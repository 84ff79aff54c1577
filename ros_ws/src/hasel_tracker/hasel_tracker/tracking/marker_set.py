"""The three markers as one frame shows them."""

from dataclasses import dataclass

import numpy as np

MARKER_NAMES = ("head", "middle", "tail")


@dataclass(frozen=True)
class MarkerSet:
    """Positions (3, 2) [px] and quality (3,) of head, middle, tail; a lost marker is NaN with quality 0."""

    positions: np.ndarray
    quality: np.ndarray

    @classmethod
    def lost(cls) -> "MarkerSet":
        """No marker found."""
        return cls(np.full((3, 2), np.nan), np.zeros(3))

    @property
    def found(self) -> np.ndarray:
        """Which markers have a position, shape (3,)."""
        return ~np.isnan(self.positions[:, 0])

    def __str__(self) -> str:
        words = [
            f"{name} ({x:.2f}, {y:.2f}) px" if found else f"{name} lost"
            for name, (x, y), found in zip(MARKER_NAMES, self.positions, self.found, strict=True)
        ]
        return ", ".join(words)
