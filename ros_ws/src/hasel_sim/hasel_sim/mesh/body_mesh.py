"""The mesh of a planar strip: soft halves, on a spine or not, columns along the body and layers through it."""

from dataclasses import dataclass

import numpy as np

from hasel_sim.mesh.mesh import Mesh, Region
from hasel_sim.mesh.outline import half_height
from hasel_sim.mesh.stations import fin_stations, plain_stations, spined_stations, with_middles
from hasel_sim.mesh.strip import StripBuilder, levels_between


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
