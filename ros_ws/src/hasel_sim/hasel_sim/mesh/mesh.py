"""A planar mesh of eight-node quadrilaterals, numbered column by column along the body."""

from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property

import numpy as np

from hasel_sim.mesh.serendipity import shape_functions


class Region(IntEnum):
    """Where an element lies: in the spine, in a muscle above or below it, or in neither."""

    SOFT = 0
    SPINE = 1
    UPPER_MUSCLE = 2
    LOWER_MUSCLE = 3


@dataclass(frozen=True)
class Mesh:
    """Nodes, elements and what lies where.

    nodes: reference positions [m], shape [nodes, 2]; elements: node numbers, shape [elements, 8];
    region: `Region` of each element; muscle: number of the muscle that runs through it, from 1, or 0; material: number
    of the region of other material it lies in, from 1, or 0; tip: nodes of the face at the far end, from bottom to top;
    skin: node numbers of the outline's edges, shape [edges, 3], with the body to
    the left of the edge's direction; clamped: numbers of the nodes held fixed.
    """

    nodes: np.ndarray
    elements: np.ndarray
    region: np.ndarray
    muscle: np.ndarray
    material: np.ndarray
    tip: np.ndarray
    skin: np.ndarray
    clamped: np.ndarray

    @cached_property
    def reach(self) -> np.ndarray:
        """How far each degree of freedom reaches to higher-numbered ones in a factorised matrix, [2 nodes]."""
        last = np.arange(len(self.nodes))
        np.maximum.at(last, self.elements, self.elements.max(axis=1)[:, None])
        last = np.maximum.accumulate(last)
        unknown = np.arange(2 * len(last))
        return 2 * np.repeat(last, 2) + 1 - unknown

    def point(self, position: tuple[float, float]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Where a material point sits: its element's nodes [8], shape functions [8] and gradients [1/m] [8, 2].

        Raises ValueError when the point lies outside the mesh.
        """
        if position not in self._points:
            self._points[position] = self._found(position)
        return self._points[position]

    @cached_property
    def _points(self) -> dict:
        """Points that were asked for before."""
        return {}

    def _found(self, position: tuple[float, float]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        best, every = None, self.nodes[self.elements]
        near = np.all((position >= every.min(axis=1) - 1e-9) & (position <= every.max(axis=1) + 1e-9), axis=1)
        for element, corners in zip(self.elements[near], every[near], strict=True):
            local = np.zeros(2)
            for _ in range(20):
                value, slope = shape_functions(*local)
                step = np.linalg.solve(corners.T @ slope, np.asarray(position) - value @ corners)
                local += step
                if np.abs(step).max() < 1e-15:
                    break
            if np.abs(local).max() < 1 + 1e-6 and (best is None or np.abs(local).max() < best[0]):
                value, slope = shape_functions(*local)
                best = np.abs(local).max(), element, value, slope @ np.linalg.inv(corners.T @ slope)
        if best is None:
            raise ValueError(f"the point {tuple(position)} m lies outside the body")
        return best[1], best[2], best[3]
