"""Meshes of the two kinds of body: the swimmer (outline, spine, fin) and the plain rectangle."""

import numpy as np

from hasel_sim.mesh.mesh import Mesh, Region
from hasel_sim.mesh.strip import StripBuilder, levels_between, spread


def half_height(coefficients: np.ndarray, largest_half_height: float, s: np.ndarray) -> np.ndarray:
    """Half height [m] of the outline at s = x / length, a polynomial in s scaled with the largest half height."""
    return largest_half_height * np.polynomial.polynomial.polyval(s, coefficients)


def outline_fault(
    coefficients: np.ndarray, largest_half_height: float, spine_thickness: float, body_length: float
) -> str | None:
    """A sentence about where the outline crosses the spine, and so maybe itself; None where it does not."""
    s = np.linspace(0, 1, 401)
    height = half_height(coefficients, largest_half_height, s)
    if np.all(height > 0.5 * spine_thickness):
        return None
    return (
        f"the outline is {2e3 * height.min():.2f} mm high at x = {1e3 * s[np.argmin(height)] * body_length:.0f} mm "
        f"and crosses the spine of {1e3 * spine_thickness:.2f} mm; expected a body higher than its spine everywhere: "
        "change outline_coefficients or spine_thickness_m"
    )


def _elements(nominal: int, density: float) -> int:
    return max(1, round(nominal * density))


def swimmer_mesh(
    *,
    body_length: float,
    fin_length: float,
    spine_thickness: float,
    largest_half_height: float,
    outline: np.ndarray,
    head_length: float,
    muscle_end: float,
    density: float,
) -> Mesh:
    """Mesh a swimmer: two soft halves on a spine that goes on as the tail fin. All lengths in m.

    density 1 gives 4 elements along the head, 14 along the muscles, 1 to the fin and 24 along the fin, one through
    each half and one through the spine (336 nodes); other densities scale every count.
    """
    through = _elements(1, density)
    stations = [
        spread(0.0, head_length, _elements(4, density)),
        spread(head_length, muscle_end, _elements(14, density))[1:],
        spread(muscle_end, body_length, _elements(1, density))[1:],
    ]
    x = np.concatenate(stations)
    layers = [through, 1, through]
    half_spine = 0.5 * spine_thickness
    powers = np.arange(len(outline))

    strip = StripBuilder()
    columns = []
    for index, position in enumerate(x):
        s = position / body_length
        height = half_height(outline, largest_half_height, s)
        full = index % 2 == 0
        levels = levels_between(np.array([-height, -half_spine, half_spine, height]), layers, full)
        growth = levels_between(np.array([-1.0, 0.0, 0.0, 1.0]), layers, full)
        columns.append(strip.column(position, levels, largest_half_height * s ** powers[:, None] * growth))
    for index in range(0, len(x) - 1, 2):
        muscle = head_length - 1e-9 < x[index] < muscle_end - 1e-9
        upper = Region.UPPER_MUSCLE if muscle else Region.SOFT
        lower = Region.LOWER_MUSCLE if muscle else Region.SOFT
        regions = [lower] * through + [Region.SPINE] + [upper] * through
        strip.add_elements(columns[index], columns[index + 1], columns[index + 2], regions)
    strip.end_face(columns[0][::-1])
    for soft_face in (columns[-1][: 2 * through + 1], columns[-1][2 * through + 2 :]):
        strip.end_face(soft_face)

    spine_nodes = columns[-1][2 * through : 2 * through + 3]
    fin_x = spread(body_length, body_length + fin_length, _elements(24, density))
    fin_columns = [spine_nodes]
    for index, position in enumerate(fin_x[1:], start=1):
        levels = np.linspace(-half_spine, half_spine, 3 if index % 2 == 0 else 2)
        fin_columns.append(strip.column(position, levels, np.zeros((len(outline), len(levels)))))
    for index in range(0, len(fin_x) - 1, 2):
        strip.add_elements(*fin_columns[index : index + 3], [Region.SPINE])
    strip.end_face(fin_columns[-1])
    return strip.finish(clamped=np.array([], dtype=int))


def rectangle_mesh(
    *, length: float, height: float, clamped: bool, elements_along: int, elements_through: int
) -> Mesh:
    """Mesh a plain rectangle from x = 0 to length, y = -height/2 to height/2 [m], optionally clamped at x = 0."""
    strip = StripBuilder()
    x = spread(0.0, length, elements_along)
    faces = np.array([-0.5 * height, 0.5 * height])
    columns = []
    for index, position in enumerate(x):
        levels = levels_between(faces, [elements_through], middle_nodes=index % 2 == 0)
        columns.append(strip.column(position, levels, np.zeros((0, len(levels)))))
    for index in range(0, len(x) - 1, 2):
        strip.add_elements(*columns[index : index + 3], [Region.SOFT] * elements_through)
    strip.end_face(columns[-1])
    if not clamped:
        strip.end_face(columns[0][::-1])
    return strip.finish(clamped=columns[0] if clamped else np.array([], dtype=int))
