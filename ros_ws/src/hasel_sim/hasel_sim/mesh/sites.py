# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Places where forces act: the body, the skin, the centre line, points of it; each interpolates a few nodes.

Fields of the loops are [columns, nodes or sites, 2, lanes]; nodes and weights [sites, nodes per site].
"""

from dataclasses import dataclass, replace

import numpy as np
from numba import njit

from hasel_sim.mesh.mesh import Mesh, edge_functions, reference_gradients
from hasel_sim.simd import LaneTuple, Value, add, lane_tuple, load, store, zero


@njit(cache=True, fastmath=True, error_model="numpy")
def interpolate(
    field: np.ndarray, nodes: np.ndarray, weights: np.ndarray, out: np.ndarray, lane: LaneTuple
) -> None:
    """Write what the weights make of a nodal field at the sites."""
    lanes, to = len(lane), 0
    for c in range(field.shape[0]):
        for s in range(nodes.shape[0]):
            x, y = _at_site(field, c, s, nodes, weights, lane)
            store(out, to, x)
            store(out, to + lanes, y)
            to += 2 * lanes


@njit(cache=True, fastmath=True, error_model="numpy")
def spread(
    force: np.ndarray, nodes: np.ndarray, weights: np.ndarray, out: np.ndarray, lane: LaneTuple
) -> None:
    """Add forces at the sites, times the weights, to a nodal field."""
    lanes, at = len(lane), 0
    for c in range(force.shape[0]):
        for s in range(nodes.shape[0]):
            x, y = load(force, at, lane), load(force, at + lanes, lane)
            _add_at_nodes(x, y, c, s, nodes, weights, out, lane)
            at += 2 * lanes


@njit(cache=True, fastmath=True, error_model="numpy")
def subtract_products(
    field: np.ndarray,
    slope: np.ndarray,
    nodes: np.ndarray,
    shape: np.ndarray,
    weights: np.ndarray,
    out: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Subtract slope [sites, 2, 2, lanes] times the field at the sites, times the weights, from a nodal field."""
    lanes = len(lane)
    for c in range(field.shape[0]):
        for s in range(nodes.shape[0]):
            x, y = _at_site(field, c, s, nodes, shape, lane)
            at = 4 * s * lanes
            along = load(slope, at, lane) * x + load(slope, at + lanes, lane) * y
            across = load(slope, at + 2 * lanes, lane) * x + load(slope, at + 3 * lanes, lane) * y
            _add_at_nodes(-1.0 * along, -1.0 * across, c, s, nodes, weights, out, lane)


@njit(inline="always")
def _at_site(
    field: np.ndarray, c: int, s: int, nodes: np.ndarray, weights: np.ndarray, lane: LaneTuple
) -> tuple[Value, Value]:
    lanes, x, y = len(lane), zero(lane), zero(lane)
    for k in range(nodes.shape[1]):
        at = 2 * lanes * (c * field.shape[1] + nodes[s, k])
        x = x + weights[s, k] * load(field, at, lane)
        y = y + weights[s, k] * load(field, at + lanes, lane)
    return x, y


@njit(inline="always")
def _add_at_nodes(
    x: Value,
    y: Value,
    c: int,
    s: int,
    nodes: np.ndarray,
    weights: np.ndarray,
    out: np.ndarray,
    lane: LaneTuple,
) -> None:
    lanes = len(lane)
    for k in range(nodes.shape[1]):
        at = 2 * lanes * (c * out.shape[1] + nodes[s, k])
        add(out, at, weights[s, k] * x)
        add(out, at + lanes, weights[s, k] * y)


@dataclass(frozen=True)
class Sites:
    """Interpolation at n sites from k nodes each.

    nodes [n, k]; shape [n, k] gives values; slope [n, k] gives the tangent along the skin or the centre line per unit
    reference length (zero where there is none); measure [n]: what one site stands for (reference length [m],
    mass [kg/m] or 1); weight [n, k]: what of a force at a site acts on each node, mostly shape times measure.
    """

    nodes: np.ndarray
    shape: np.ndarray
    slope: np.ndarray
    measure: np.ndarray
    weight: np.ndarray

    @staticmethod
    def of(nodes: np.ndarray, shape: np.ndarray, slope: np.ndarray, measure: np.ndarray) -> "Sites":
        """Sites whose forces act where they are."""
        return Sites(nodes, shape, slope, measure, shape * measure[:, None])

    def same_as(self, other: "Sites") -> bool:
        """Whether another object describes the same sites."""
        pairs = zip(vars(self).values(), vars(other).values(), strict=True)
        return all(np.array_equal(mine, theirs) for mine, theirs in pairs)

    def value(self, field: np.ndarray) -> np.ndarray:
        """A nodal field [..., nodes, 2, lanes] at the sites, [..., n, 2, lanes]."""
        return self._interpolated(self.shape, field)

    def tangent(self, position: np.ndarray) -> np.ndarray:
        """Derivative of a nodal field along the skin or the centre line, [..., n, 2, lanes]."""
        return self._interpolated(self.slope, position)

    def _interpolated(self, weights: np.ndarray, field: np.ndarray) -> np.ndarray:
        out = np.empty((*field.shape[:-3], len(self.nodes), *field.shape[-2:]))
        interpolate(_columns(field), self.nodes, weights, _in_place(out), lane_tuple(field.shape[-1]))
        return out

    def scatter(self, force: np.ndarray, out: np.ndarray) -> None:
        """Add forces at the sites [..., n, 2, lanes], times the weight, to out [..., nodes, 2, lanes] (contiguous)."""
        spread(_columns(force), self.nodes, self.weight, _in_place(out), lane_tuple(out.shape[-1]))

    def scatter_products(
        self, slope: np.ndarray, weights: np.ndarray, field: np.ndarray, out: np.ndarray
    ) -> None:
        """Subtract forces that change with a field [..., nodes, 2, lanes] from out, of its shape (contiguous).

        The force at a site is slope [n, 2, 2, lanes] times what weights [n, k] make of the field there.
        """
        places = self.nodes, weights, self.weight
        subtract_products(_columns(field), slope, *places, _in_place(out), lane_tuple(out.shape[-1]))

    def gathered(self, weights: np.ndarray) -> np.ndarray:
        """What weights of the nodes [nodes, 2, lanes] mean for the forces at the sites, [n, 2, lanes]."""
        return self._interpolated(self.weight, weights)


def _columns(field: np.ndarray) -> np.ndarray:
    """[..., n, 2, lanes] as [columns, n, 2, lanes], contiguous."""
    return np.ascontiguousarray(field, dtype=float).reshape(-1, *field.shape[-3:])


def _in_place(out: np.ndarray) -> np.ndarray:
    """The same memory as [columns, n, 2, lanes]; what is not contiguous is refused."""
    columns = out.view()
    columns.shape = (-1, *out.shape[-3:])
    return columns


def body_sites(mesh: Mesh, nodes: np.ndarray, density: np.ndarray) -> Sites:
    """3 x 3 Gauss points in every element, standing for their mass [kg per m depth]; density [kg/m^3] [elements].

    These are the points of the consistent mass: a force per mass that is the same everywhere then accelerates the body
    without bending it.
    """
    values, _, areas = reference_gradients(nodes[mesh.elements], 3)
    points = areas.shape[1]
    return Sites.of(
        np.repeat(mesh.elements, points, axis=0),
        np.tile(values, (len(mesh.elements), 1)),
        np.zeros((areas.size, values.shape[1])),
        (density[:, None] * areas).ravel(),
    )


def with_point_mass(body: Sites, mesh: Mesh, mass: float) -> Sites:
    """The sites of a body and one more: a mass [kg per m depth] on the centre line of the face at the far end."""
    tip = mesh.nodes[mesh.tip]
    point = point_sites(mesh, np.array([[tip[0, 0], 0.5 * (tip[0, 1] + tip[-1, 1])]]))
    joined = (np.concatenate(pair) for pair in zip(*(vars(s).values() for s in (body, point)), strict=True))
    nodes, shape, slope, measure, _ = joined
    measure[-1] = mass
    return Sites.of(nodes, shape, slope, measure)


def skin_sites(mesh: Mesh) -> Sites:
    """Two Gauss points on every edge of the outline, standing for their reference length [m]."""
    points, weights = np.polynomial.legendre.leggauss(2)
    nodes, shape, slope, measure = [], [], [], []
    for edge in mesh.skin:
        for point, weight in zip(points, weights, strict=True):
            value, derivative = edge_functions(point)
            length = np.linalg.norm(derivative @ mesh.nodes[edge])
            nodes.append(edge)
            shape.append(value)
            slope.append(derivative / length)
            measure.append(weight * length)
    return Sites.of(np.array(nodes), np.array(shape), np.array(slope), np.array(measure))


def line_sites(mesh: Mesh) -> Sites:
    """Two Gauss points in every element along the centre line, and the tail's end, which stands for no length [m]."""
    points, weights = np.polynomial.legendre.leggauss(2)
    every = mesh.nodes[mesh.elements]
    crossed = (every[..., 1].min(axis=1) <= 0.0) & (every[..., 1].max(axis=1) >= 0.0)
    ends = np.unique(np.round(every[crossed][:, :4, 0], 12))
    middle, half = 0.5 * (ends[1:] + ends[:-1]), 0.5 * np.diff(ends)
    places = np.append((middle[:, None] + half[:, None] * points).ravel(), mesh.nodes[mesh.tip, 0].mean())
    found = [mesh.point((float(x), 0.0)) for x in places]
    nodes, shape, gradient = (np.array(part) for part in zip(*found, strict=True))
    measure = np.append((half[:, None] * weights).ravel(), 0.0)
    return Sites.of(nodes, shape, np.ascontiguousarray(gradient[..., 0]), measure)


def flux_sites(line: Sites, sheds: bool = True) -> Sites:
    """The sites of a centre line for a flux along it instead of a force.

    A flux G [N/m] acts by its divergence, less what leaves at the tail: on a field phi of displacements it does the
    work G(L) phi(L) - integral of G dphi/ds, so that the sum of its forces is G at the tail. Without shedding the first
    term is absent, and the sum is 0.
    """
    weight = -line.slope * line.measure[:, None]
    weight[-1] = line.shape[-1] if sheds else 0.0
    return replace(line, weight=weight)


def point_sites(mesh: Mesh, positions: np.ndarray) -> Sites:
    """Material points at the given reference positions [m] [n, 2], each standing for 1."""
    found = [mesh.point(tuple(position)) for position in positions]
    return Sites.of(
        np.array([nodes for nodes, _, _ in found]),
        np.array([shape for _, shape, _ in found]),
        np.zeros((len(found), 8)),
        np.ones(len(found)),
    )
