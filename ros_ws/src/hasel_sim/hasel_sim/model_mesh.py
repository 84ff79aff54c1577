# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""From a model to its mesh and markers, and from these to the measured angle."""

from dataclasses import replace
from functools import lru_cache
from types import SimpleNamespace

import numpy as np
from hasel_recording.recording import sin_theta_from_markers

from hasel_sim.effects.base import ObservationEffect, guarded
from hasel_sim.errors import ModelError
from hasel_sim.mesh.body_mesh import StripShape, strip_mesh
from hasel_sim.mesh.mesh import Mesh
from hasel_sim.model import Model
from hasel_sim.model.description import Description
from hasel_sim.model.model_parameters import moved_points
from hasel_sim.model.sections import Body


class MarkerRows:
    """Interpolates marker positions and the lines across the body through them from nodal positions.

    Fixed markers stay where they are and need no mesh.
    """

    def __init__(self, mesh: Mesh, points: np.ndarray, fixed: np.ndarray) -> None:
        count = len(points)
        self.nodes = np.zeros((count, 8), dtype=int)
        self._shape, self._across = np.zeros((count, 8)), np.zeros((count, 8))
        self._offset, self._up = np.zeros((count, 2)), np.zeros((count, 2))
        for index, point in enumerate(points):
            if fixed[index]:
                self._offset[index], self._up[index] = point, (0.0, 1.0)
            else:
                nodes, shape, gradient = mesh.point(tuple(point))
                self.nodes[index], self._shape[index], self._across[index] = nodes, shape, gradient[:, 1]

    def __call__(self, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Positions [m] and lines across [..., 3, 2] for nodal positions [..., nodes, 2]."""
        return self.interpolated(self.local(position))

    def slopes(self, change: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The same for changes of the nodal positions (fixed markers do not change)."""
        return self.interpolated_slopes(self.local(change))

    def local(self, field: np.ndarray) -> np.ndarray:
        """What of a nodal field [..., nodes, 2] the markers see, [..., 3, 8, 2]: all that a series needs to keep."""
        return field[..., self.nodes, :]

    def interpolated(self, local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Positions [m] and lines across [..., 3, 2] from local nodal positions."""
        where, across = self.interpolated_slopes(local)
        return where + self._offset, across + self._up

    def interpolated_slopes(self, local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The same from changes of the local nodal positions."""
        return (
            np.einsum("mk,...mkd->...md", self._shape, local),
            np.einsum("mk,...mkd->...md", self._across, local),
        )

    def add_pulled_back(self, where: np.ndarray, across: np.ndarray, out: np.ndarray) -> None:
        """Add to out [nodes, 2] what weights of positions and lines [3, 2] mean for the nodes."""
        share = self._shape[:, :, None] * where[:, None, :] + self._across[:, :, None] * across[:, None, :]
        np.add.at(out, self.nodes, share)


def observe(
    time: np.ndarray,
    positions: np.ndarray,
    across: np.ndarray,
    effects: list[ObservationEffect],
    values: dict[str, SimpleNamespace],
) -> np.ndarray:
    """The measured series [n] from marker positions and lines across [n, 3, 2] at times [s] [n]."""
    for effect in effects:
        positions = guarded(effect, "markers", positions, across, values[effect.id])
    series = sin_theta_from_markers(positions)
    for effect in effects:
        series = guarded(effect, "angle", time, series, values[effect.id])
    return series


@lru_cache(maxsize=16)
def _strip(shape: StripShape, density: float, layers: int) -> Mesh:
    return strip_mesh(shape, density, layers)


def body_mesh(description: Description) -> Mesh:
    """The mesh of a described body. Raises ModelError when the outline crosses the spine or itself."""
    body, numerics = description.body, description.numerics
    _check_shape(body)
    shape = body.shape(tuple(muscle.stretch for muscle in description.muscles))
    return _strip(shape, numerics.mesh_density, numerics.layers)


def _check_shape(body: Body) -> None:
    if body.outline_fault:
        raise ModelError(body.outline_fault)


def model_mesh(model: Model) -> Mesh:
    """The mesh of a model: that of the file's shape, its nodes moved where numbers of the shape have other values."""
    mesh, before, after = body_mesh(model.description), model.description.body, model.described.body
    if after is before:
        return mesh
    for name in ("body.spine.thickness_m", "body.spine.fin_length_m"):
        value = model.values.get(name, 1.0)
        if value <= 0:
            raise ModelError(f"{name} is {value:g}; expected more than 0: choose another value")
    _check_shape(after)
    return replace(mesh, nodes=moved_points(mesh.nodes, before, after))


def marker_points(model: Model) -> np.ndarray:
    """Reference positions [m] of head, middle and tail marker and of all others, [markers, 2]."""
    markers, names = model.described.markers, model.described.marker_names()
    return np.array([[markers[name].x_m, markers[name].y_m] for name in names])


def marker_rows(model: Model, mesh: Mesh) -> MarkerRows:
    """How the markers follow from nodal positions."""
    fixed = [model.description.markers[name].fixed for name in model.description.marker_names()]
    return MarkerRows(mesh, marker_points(model), np.array(fixed))
