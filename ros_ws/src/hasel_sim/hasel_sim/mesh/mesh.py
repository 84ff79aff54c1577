# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A planar mesh of eight-node serendipity quadrilaterals, numbered column by column along the body.

Node order: corners (-1,-1), (1,-1), (1,1), (-1,1), then mid-sides (0,-1), (1,0), (0,1), (-1,0).
With 2 x 2 quadrature an element bends and keeps its volume without locking, and its one spurious mode cannot be shared
by neighbours (Zienkiewicz, Taylor, Zhu: The Finite Element Method, 7th ed., sections 6 and 10).
"""

from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property, lru_cache

import numpy as np

Places = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
"""What the compiled loops know of a mesh: elements, gradients, areas and stretch of the stress-free shape."""
_CORNER = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


def shape_functions(xi: float, eta: float) -> tuple[np.ndarray, np.ndarray]:
    """Values [8] and slopes [8, 2] (with respect to xi, eta) at a point of the reference square."""
    value, slope = np.empty(8), np.empty((8, 2))
    for node, (a, b) in enumerate(_CORNER):
        p, q = 1 + a * xi, 1 + b * eta
        value[node] = 0.25 * p * q * (a * xi + b * eta - 1)
        slope[node] = 0.25 * a * q * (2 * a * xi + b * eta), 0.25 * b * p * (a * xi + 2 * b * eta)
    for node, b in ((4, -1.0), (6, 1.0)):
        value[node] = 0.5 * (1 - xi**2) * (1 + b * eta)
        slope[node] = -xi * (1 + b * eta), 0.5 * b * (1 - xi**2)
    for node, a in ((5, 1.0), (7, -1.0)):
        value[node] = 0.5 * (1 + a * xi) * (1 - eta**2)
        slope[node] = 0.5 * a * (1 - eta**2), -eta * (1 + a * xi)
    return value, slope


def edge_functions(xi: float) -> tuple[np.ndarray, np.ndarray]:
    """Values [3] and slopes [3] of the quadratic edge with nodes at -1, 0, 1."""
    return np.array([0.5 * xi * (xi - 1), 1 - xi**2, 0.5 * xi * (xi + 1)]), np.array(
        [xi - 0.5, -2 * xi, xi + 0.5]
    )


def square_quadrature(order: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss points [order**2, 2] and weights [order**2] of the reference square."""
    point, weight = np.polynomial.legendre.leggauss(order)
    points = np.array([(x, y) for y in point for x in point])
    return points, np.array([wx * wy for wy in weight for wx in weight])


@lru_cache(maxsize=8)
def _rule(order: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Shape functions [points, 8], their slopes [points, 8, 2] and the weights [points] at the Gauss points."""
    points, weights = square_quadrature(order)
    values, slopes = zip(*(shape_functions(x, y) for x, y in points), strict=True)
    return np.array(values), np.array(slopes), weights


def reference_gradients(coordinates: np.ndarray, order: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Shape functions and their gradients at the Gauss points of every element.

    coordinates: node positions per element [m], shape [elements, 8, 2].
    Returns values [points, 8], gradients [1/m] [elements, points, 8, 2] and areas [m^2] [elements, points].
    """
    values, gradients, areas = _gradients(np.asarray(coordinates, dtype=float).tobytes(), order)
    return values.copy(), gradients.copy(), areas.copy()


@lru_cache(maxsize=64)
def _gradients(coordinates: bytes, order: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The same; a fit asks for those of one mesh again and again."""
    values, slopes, weights = _rule(order)
    jacobian = np.einsum("gad,eac->egcd", slopes, np.frombuffer(coordinates).reshape(-1, 8, 2))
    determinant = np.linalg.det(jacobian)
    gradients = np.einsum("gad,egdc->egac", slopes, np.linalg.inv(jacobian))
    return values, gradients, determinant * weights


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
    def _points(self) -> dict[tuple[float, float], tuple[np.ndarray, np.ndarray, np.ndarray]]:
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
