"""From marker positions to the measured angle."""

from types import SimpleNamespace

import numpy as np
from hasel_recording.recording import sin_theta_from_markers

from hasel_sim.effects.base import ObservationEffect
from hasel_sim.effects.guarded import guarded
from hasel_sim.mesh.mesh import Mesh


class MarkerRows:
    """Interpolates marker positions and the lines across the body through them from nodal positions.

    Fixed markers stay where they are and need no mesh.
    """

    def __init__(self, mesh: Mesh, points: np.ndarray, fixed: np.ndarray) -> None:
        count = len(points)
        self.nodes = np.zeros((count, 8), dtype=int)
        self._shape, self._across = np.zeros((count, 8)), np.zeros((count, 8))
        self._offset, self._up = np.zeros((count, 2)), np.zeros((count, 2))
        for index, point in enumerate(points):
            if fixed[index]:
                self._offset[index], self._up[index] = point, (0.0, 1.0)
            else:
                nodes, shape, gradient = mesh.point(tuple(point))
                self.nodes[index], self._shape[index], self._across[index] = nodes, shape, gradient[:, 1]

    def __call__(self, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Positions [m] and lines across [..., 3, 2] for nodal positions [..., nodes, 2]."""
        return self.interpolated(self.local(position))

    def slopes(self, change: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The same for changes of the nodal positions (fixed markers do not change)."""
        return self.interpolated_slopes(self.local(change))

    def local(self, field: np.ndarray) -> np.ndarray:
        """What of a nodal field [..., nodes, 2] the markers see, [..., 3, 8, 2]: all that a series needs to keep."""
        return field[..., self.nodes, :]

    def interpolated(self, local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Positions [m] and lines across [..., 3, 2] from local nodal positions."""
        where, across = self.interpolated_slopes(local)
        return where + self._offset, across + self._up

    def interpolated_slopes(self, local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The same from changes of the local nodal positions."""
        return (
            np.einsum("mk,...mkd->...md", self._shape, local),
            np.einsum("mk,...mkd->...md", self._across, local),
        )

    def add_pulled_back(self, where: np.ndarray, across: np.ndarray, out: np.ndarray) -> None:
        """Add to out [nodes, 2] what weights of positions and lines [3, 2] mean for the nodes."""
        share = self._shape[:, :, None] * where[:, None, :] + self._across[:, :, None] * across[:, None, :]
        np.add.at(out, self.nodes, share)


def observe(
    time: np.ndarray,
    positions: np.ndarray,
    across: np.ndarray,
    effects: list[ObservationEffect],
    values: dict[str, SimpleNamespace],
) -> np.ndarray:
    """The measured series [n] from marker positions and lines across [n, 3, 2] at times [s] [n]."""
    for effect in effects:
        positions = guarded(effect, "markers", positions, across, values[effect.id])
    series = sin_theta_from_markers(positions)
    for effect in effects:
        series = guarded(effect, "angle", time, series, values[effect.id])
    return series
