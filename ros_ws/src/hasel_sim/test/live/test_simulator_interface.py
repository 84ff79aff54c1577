# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The triangles of the picture cover the body."""

import numpy as np
from hasel_sim.live.simulator_interface import region_triangles, skin_line
from hasel_sim.mesh.mesh import Region
from hasel_sim.model_mesh import model_mesh


def _area(nodes: np.ndarray, corners: np.ndarray) -> float:
    a, b, c = np.moveaxis(nodes[corners].reshape(-1, 3, 2), 1, 0)
    u, v = b - a, c - a
    return float((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2)


def test_a_rectangle_is_covered_once(rectangle):
    """The triangles' area is that of the body, and the outline is as long as its circumference."""
    mesh = model_mesh(rectangle(length=0.1, height=0.005))
    triangles = region_triangles(mesh)
    assert np.isclose(sum(_area(mesh.nodes, corners) for corners in triangles.values()), 0.1 * 0.005)
    ends = mesh.nodes[skin_line(mesh)].reshape(-1, 2, 2)
    assert np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum() >= 2 * 0.1 + 0.005 - 1e-9


def test_the_swimmers_muscles_lie_on_their_sides(swimmer):
    """Upper above, lower below the centre line; all four regions are there."""
    mesh = model_mesh(swimmer)
    triangles = region_triangles(mesh)
    assert set(triangles) == set(Region)
    assert mesh.nodes[triangles[Region.UPPER_MUSCLE], 1].min() > 0
    assert mesh.nodes[triangles[Region.LOWER_MUSCLE], 1].max() < 0
