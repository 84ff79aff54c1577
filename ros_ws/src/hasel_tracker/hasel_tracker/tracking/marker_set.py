"""The markers as one frame shows them."""

from dataclasses import dataclass

import numpy as np

from hasel_tracker.tracking.doubt import Doubt

MARKER_NAMES = ("head", "middle", "tail")


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
