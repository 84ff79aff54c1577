"""What is kept of a motion: where the markers' nodes are at every boundary between steps, and how that changes."""

from dataclasses import dataclass

import numpy as np

from hasel_sim.mechanics.state import State, StateSlopes


@dataclass(frozen=True)
class Seen:
    """Positions [m] of the nodes around the markers, and where asked for of all nodes.

    nodes: around the markers [markers, 8]; local: their positions [boundaries, markers, 8, 2, lanes]; slopes: what
    these change [boundaries, columns, markers, 8, 2, lanes]; shapes: all positions [boundaries, nodes, 2, lanes], or an
    empty first axis.
    """

    nodes: np.ndarray
    local: np.ndarray
    slopes: np.ndarray
    shapes: np.ndarray

    @staticmethod
    def of(nodes: np.ndarray, boundaries: int, state: State, columns: int, keep_shapes: bool) -> "Seen":
        """Room for so many boundaries and columns of derivatives."""
        place = (*nodes.shape, 2, state.position.shape[-1])
        shapes = np.zeros((boundaries if keep_shapes else 0, *state.position.shape))
        return Seen(nodes, np.zeros((boundaries, *place)), np.zeros((boundaries, columns, *place)), shapes)

    def note(self, boundary: int, state: State, slopes: StateSlopes) -> None:
        """Keep what is seen at a boundary between steps."""
        self.local[boundary] = state.position[self.nodes]
        if len(self.shapes):
            self.shapes[boundary] = state.position
        self.note_slopes(boundary, slopes)

    def note_slopes(self, boundary: int, slopes: StateSlopes) -> None:
        """Keep only how that changes."""
        if self.slopes.shape[1]:
            np.take(slopes.position, self.nodes, axis=1, out=self.slopes[boundary])
