"""From a model to its mesh and markers."""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from hasel_sim.errors import ModelError
from hasel_sim.mesh.body_mesh import StripShape, outline_fault, strip_mesh
from hasel_sim.mesh.mesh import Mesh
from hasel_sim.model import Model
from hasel_sim.model.body import Body
from hasel_sim.model.description import Description
from hasel_sim.model.moved import moved_points
from hasel_sim.observation import MarkerRows


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
    coefficients = np.array(body.coefficients)
    fault = outline_fault(coefficients, body.largest_half_height_m, body.spine_thickness_m, body.length_m)
    if fault:
        raise ModelError(fault)


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
