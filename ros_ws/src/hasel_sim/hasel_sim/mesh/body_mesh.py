# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The mesh of a planar strip: soft halves, on a spine or not, columns along the body and layers through it.

Columns stand evenly within a segment and are graded into the root of the fin. The corner between the body's blunt end
and the thin fin is singular: there even refinement converges at first order only, while geometric grading towards it
converges with the elements' own order (Babuska, Guo, The h-p version of the finite element method, Computational
Mechanics 1 (1986) 21).
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from hasel_sim.mesh.mesh import Mesh, Region

MUSCLE_ELEMENT = 2.0 / 3.0
"""Length of an element beside the spine over the body's largest height, where muscles bend it."""
PASSIVE_ELEMENT = 1.75
"""The same where no muscle lies between it and the nose: that part hardly bends."""
PLAIN_ELEMENT = 0.25
"""The same in a body without spine, whose own height sets the scale of what is to be resolved."""
MOST_PLAIN = 24
"""Elements along a slender body without spine: enough for the elastica, whatever its height."""
ROOT_ELEMENT = 1.0 / 16.0
"""Length of the elements on both sides of the fin's root over the spine's thickness, at density 1."""
THINNEST = 1.0 / 64.0
"""The same at any density: thinner ones no longer matter, and their shape spoils the solution."""
FIN_ELEMENTS, GAP_ELEMENTS = 14, 6
"""Elements along the fin, and along the last piece of the body before it."""


def half_height(coefficients: np.ndarray, largest_half_height: float, s: float | np.ndarray) -> np.ndarray:
    """Half height [m] of the outline at s = x / length, a polynomial in s scaled with the largest half height."""
    return largest_half_height * np.polynomial.polynomial.polyval(s, coefficients)


def outline_fault(
    coefficients: np.ndarray, largest_half_height: float, spine_thickness: float, length: float
) -> str | None:
    """A sentence about where the outline crosses the spine, and so maybe itself; None where it does not."""
    s = np.linspace(0, 1, 401)
    height = half_height(coefficients, largest_half_height, s)
    if np.all(height > 0.5 * spine_thickness):
        return None
    crossed = (
        f"the spine of {1e3 * spine_thickness:.2f} mm"
        if spine_thickness
        else "the centre line, and so itself"
    )
    return (
        f"the outline is {2e3 * height.min():.2f} mm high at x = {1e3 * s[np.argmin(height)] * length:.0f} mm "
        f"and crosses {crossed}; expected a body higher than its spine everywhere: change the outline's "
        "coefficients or the spine's thickness_m"
    )


def graded(start: float, end: float, first: float, count: int) -> np.ndarray:
    """Ends of `count` elements from start to end [m], each longer than the last by one factor, the first one given.

    Equal ones where that would make them shorter instead. [count + 1]
    """
    length = abs(end - start)
    if count < 2 or first * count >= length:
        return np.linspace(start, end, count + 1)
    powers = np.arange(count)
    largest = (length / first) ** (1 / (count - 1))
    growth = brentq(lambda g: first * (g**powers).sum() - length, 1.0, largest)
    ends = np.concatenate([[0.0], np.cumsum(growth**powers)])
    return start + np.sign(end - start) * length * ends / ends[-1]


def plain_stations(breaks: np.ndarray, height: float, density: float) -> np.ndarray:
    """Element ends along a body without spine that is cut at `breaks` [m] [n]; height: its largest [m]."""
    size = max(PLAIN_ELEMENT * height, (breaks[-1] - breaks[0]) / MOST_PLAIN) / density
    return _joined([_even(a, b, size) for a, b in zip(breaks[:-1], breaks[1:], strict=True)])


def spined_stations(
    breaks: np.ndarray, height: float, first_muscle: float, density: float, thickness: float, has_fin: bool
) -> np.ndarray:
    """Element ends along a body with a spine [m]; first_muscle: where the first muscle begins."""
    pieces = []
    for a, b in zip(breaks[:-1], breaks[1:], strict=True):
        passive = b <= first_muscle + 1e-9
        size = (PASSIVE_ELEMENT if passive else MUSCLE_ELEMENT) * height / density
        if has_fin and b == breaks[-1]:
            count = max(1, round(GAP_ELEMENTS * density)) + int(max(0.0, b - a - height) / size)
            pieces.append(graded(b, a, root_element(thickness, density), count)[::-1])
        else:
            pieces.append(_even(a, b, size))
    return _joined(pieces)


def fin_stations(start: float, end: float, thickness: float, density: float) -> np.ndarray:
    """Element ends along the fin [m], graded away from its root."""
    return graded(start, end, root_element(thickness, density), max(2, round(FIN_ELEMENTS * density)))


def root_element(thickness: float, density: float) -> float:
    """Length [m] of the elements on both sides of the fin's root."""
    return max(ROOT_ELEMENT / density, THINNEST) * thickness


def with_middles(ends: np.ndarray) -> np.ndarray:
    """The positions of all columns: element ends and the columns half-way between them, [2 n - 1]."""
    out = np.empty(2 * len(ends) - 1)
    out[::2] = ends
    out[1::2] = 0.5 * (ends[:-1] + ends[1:])
    return out


def _even(start: float, end: float, size: float) -> np.ndarray:
    """Ends of equal elements of about this size [m]."""
    return np.linspace(start, end, max(1, round((end - start) / size)) + 1)


def _joined(pieces: list[np.ndarray]) -> np.ndarray:
    return np.concatenate([pieces[0], *(piece[1:] for piece in pieces[1:])])


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


@dataclass(frozen=True)
class Stretch:
    """A piece of the body from x = start to end [m] in some of the layers `lower`, `spine` and `upper`."""

    start: float
    end: float
    layers: tuple[str, ...]

    def holds(self, x: float, layer: str) -> bool:
        """Whether an element around x [m] in this layer belongs to it."""
        return self.start < x < self.end and layer in self.layers


@dataclass(frozen=True)
class StripShape:
    """All that a mesh follows, lengths in m.

    outline: coefficients of the half height over the largest one; spine: its thickness, 0 for none; muscles and
    regions in their order.
    """

    length: float
    largest_half_height: float
    outline: tuple[float, ...]
    spine: float = 0.0
    fin_length: float = 0.0
    clamped: bool = False
    muscles: tuple[Stretch, ...] = ()
    regions: tuple[Stretch, ...] = ()


def strip_mesh(shape: StripShape, density: float, layers: int) -> Mesh:
    """Mesh a strip. density scales the number of elements along it; layers: elements through each soft half."""
    strip = StripBuilder()
    columns = _body(strip, shape, with_middles(_stations(shape, density)), layers)
    clamped = columns[0] if shape.clamped else np.array([], dtype=int)
    if not shape.clamped:
        strip.end_face(columns[0][::-1])
    tip = columns[-1]
    if shape.fin_length:
        for soft_face in (tip[: 2 * layers + 1], tip[2 * layers + 2 :]):
            strip.end_face(soft_face)
        tip = _fin(strip, shape, tip[2 * layers : 2 * layers + 3], density)
    strip.end_face(tip)
    return strip.finish(clamped, tip)


def _stations(shape: StripShape, density: float) -> np.ndarray:
    marks = [
        0.0,
        shape.length,
        *(x for part in shape.muscles + shape.regions for x in (part.start, part.end)),
    ]
    breaks = np.unique(np.round([x for x in marks if 0.0 <= x <= shape.length], 9))
    s = np.linspace(0.0, 1.0, 401)
    height = 2 * half_height(np.array(shape.outline), shape.largest_half_height, s).max()
    if not shape.spine:
        return plain_stations(breaks, height, density)
    first = min((muscle.start for muscle in shape.muscles), default=0.0)
    return spined_stations(breaks, height, first, density, shape.spine, shape.fin_length > 0)


def _body(strip: StripBuilder, shape: StripShape, x: np.ndarray, layers: int) -> list[np.ndarray]:
    """Add the columns and elements of the body; the columns' node numbers come back."""
    half_spine = 0.5 * shape.spine
    names = ["lower"] * layers + (["spine"] if shape.spine else []) + ["upper"] * layers
    counts = [layers, 1, layers] if shape.spine else [layers, layers]
    centre = [-half_spine, half_spine] if shape.spine else [0.0]
    columns = []
    for index, position in enumerate(x):
        s = position / shape.length
        height = float(half_height(np.array(shape.outline), shape.largest_half_height, s))
        levels = levels_between(np.array([-height, *centre, height]), counts, index % 2 == 0)
        columns.append(strip.column(position, levels))
    for index in range(0, len(x) - 1, 2):
        labels = [_label(shape, x[index + 1], name) for name in names]
        strip.add_elements(columns[index], columns[index + 1], columns[index + 2], labels)
    return columns


def _label(shape: StripShape, x: float, layer: str) -> tuple[int, int, int]:
    """Region, muscle and region of other material of an element around x [m]."""
    muscle = next((n for n, part in enumerate(shape.muscles, start=1) if part.holds(x, layer)), 0)
    material = next((n for n, part in enumerate(shape.regions, start=1) if part.holds(x, layer)), 0)
    if layer == "spine":
        return Region.SPINE, 0, material
    within = Region.UPPER_MUSCLE if layer == "upper" else Region.LOWER_MUSCLE
    return within if muscle else Region.SOFT, muscle, material


def _fin(strip: StripBuilder, shape: StripShape, root: np.ndarray, density: float) -> np.ndarray:
    """Add the fin behind the spine's nodes at its root [3]; its last column comes back."""
    end = shape.length + shape.fin_length
    x = with_middles(fin_stations(shape.length, end, shape.spine, density))
    columns = [root]
    for index, position in enumerate(x[1:], start=1):
        levels = np.linspace(-0.5 * shape.spine, 0.5 * shape.spine, 3 if index % 2 == 0 else 2)
        columns.append(strip.column(position, levels))
    for index in range(0, len(x) - 1, 2):
        label = (Region.SPINE, 0, _label(shape, x[index + 1], "spine")[2])
        strip.add_elements(columns[index], columns[index + 1], columns[index + 2], [label])
    return columns[-1]
