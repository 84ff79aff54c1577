"""A strip of quadrilaterals: columns along the body, layers through its height."""

import numpy as np

from hasel_sim.mesh.mesh import Mesh


class StripBuilder:
    """Collects columns of nodes and the elements between them.

    A station is one position along the body; every element spans two stations and has its mid-side nodes on a column
    half-way. Nodes are numbered in the order in which columns are added, which keeps the matrix narrow-banded.
    """

    def __init__(self) -> None:
        self.nodes: list[tuple[float, float]] = []
        self.elements: list[list[int]] = []
        self.labels: list[tuple[int, int, int]] = []
        self.upper: list[list[int]] = []
        self.lower: list[list[int]] = []

    def column(self, x: float, levels: np.ndarray) -> np.ndarray:
        """Add nodes at height `levels` [m] [n]; return their numbers."""
        first = len(self.nodes)
        self.nodes += [(x, y) for y in levels]
        return np.arange(first, len(self.nodes))

    def add_elements(
        self, left: np.ndarray, middle: np.ndarray, right: np.ndarray, labels: list[tuple[int, int, int]]
    ) -> None:
        """Add one stack of elements, bottom to top.

        left, right: 2n + 1 nodes each; middle: n + 1 nodes; labels: n times region, muscle, other material.
        """
        for layer, label in enumerate(labels):
            a, b = 2 * layer, 2 * layer + 2
            self.elements.append(
                [
                    left[a],
                    right[a],
                    right[b],
                    left[b],
                    middle[layer],
                    right[a + 1],
                    middle[layer + 1],
                    left[a + 1],
                ]
            )
            self.labels.append(label)
        self.lower.append([left[0], middle[0], right[0]])
        self.upper.append([right[-1], middle[-1], left[-1]])

    def end_face(self, column: np.ndarray) -> None:
        """Add the skin across an end of the body; `column` runs with the body to its left."""
        self.lower += [[column[i], column[i + 1], column[i + 2]] for i in range(0, len(column) - 1, 2)]

    def finish(self, clamped: np.ndarray, tip: np.ndarray) -> Mesh:
        """Return the mesh; clamped: nodes held fixed; tip: nodes of the far end's face."""
        region, muscle, material = np.array(self.labels, dtype=np.int64).T
        return Mesh(
            nodes=np.array(self.nodes),
            elements=np.array(self.elements, dtype=np.int64),
            region=region,
            muscle=np.ascontiguousarray(muscle),
            material=material,
            tip=np.asarray(tip, dtype=np.int64),
            skin=np.array(self.lower + self.upper, dtype=np.int64),
            clamped=np.asarray(clamped, dtype=np.int64),
        )


def levels_between(faces: np.ndarray, layers: list[int], middle_nodes: bool) -> np.ndarray:
    """Heights [m] of nodes in a column whose layer faces are `faces` [n + 1], each layer cut into `layers` elements."""
    heights = [faces[:1]]
    for low, high, count in zip(faces[:-1], faces[1:], layers, strict=True):
        steps = 2 * count if middle_nodes else count
        heights.append(low + (high - low) * np.arange(1, steps + 1) / steps)
    return np.concatenate(heights)
