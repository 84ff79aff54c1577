"""The body as triangles, coloured by region."""

import numpy as np

from hasel_sim.mesh.mesh import Mesh, Region

COLOURS: dict[Region, tuple[float, float, float]] = {
    Region.SOFT: (0.80, 0.80, 0.82),
    Region.SPINE: (0.25, 0.25, 0.30),
    Region.UPPER_MUSCLE: (0.84, 0.37, 0.00),
    Region.LOWER_MUSCLE: (0.00, 0.45, 0.70),
}
"""Red, green and blue, 0 to 1; the muscles' are told apart by the colour-blind too."""

_CORNER_TRIANGLES = (0, 1, 2, 0, 2, 3)


def region_triangles(mesh: Mesh) -> dict[Region, np.ndarray]:
    """Node numbers of the corners of two triangles per element, [3 × triangles], by region."""
    triangles = mesh.elements[:, _CORNER_TRIANGLES]
    present = {region: triangles[mesh.region == region].ravel() for region in Region}
    return {region: corners for region, corners in present.items() if len(corners)}


def skin_line(mesh: Mesh) -> np.ndarray:
    """Node numbers at the ends of the outline's pieces, [2 × pieces]."""
    return np.concatenate([mesh.skin[:, :2], mesh.skin[:, 1:]], axis=1).ravel()
