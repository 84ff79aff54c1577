"""Numbers of a model file that may be freed: named by their path, such as `material.soft.youngs_modulus_pa`.

What all materials of a body have in common is one number besides, such as `material.density_kg_per_m3`: a body that was
weighed has one density. Among them are those of the body's shape. They move the nodes of the mesh that the file's own
shape has, and with them markers and whatever else lies on the fin: a simulation can then be differentiated by them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import numpy as np
from pydantic import BaseModel

from hasel_sim.model.moved import moved_points

if TYPE_CHECKING:
    from hasel_sim.model.body import Body
    from hasel_sim.model.description import Description

_UNITS = {
    "_kg_per_m3": "kg/m^3",
    "_kg_per_m": "kg/m",
    "_kg_m": "kg m",
    "_pa_s": "Pa s",
    "_pa": "Pa",
    "_s": "s",
    "_m": "m",
}
REST_CONTRACTION = "rest_contraction"


def constants(description: Description) -> dict[str, float]:
    """Every number that may be freed, by its path: of shape, materials, regions, muscles, tip plate and medium."""
    found = shape_constants(description)
    for path, material in _materials(description).items():
        _collect(material, path, found)
    for path, parts in shared_constants(description).items():
        found[path] = found[parts[0]]
    _collect(description.body.tip_plate, "body.tip_plate", found)
    if description.medium is not None:
        for key in ("density_kg_per_m3", "viscosity_pa_s"):
            found[f"medium.{key}"] = getattr(description.medium, key)
        found["body.depth_m"] = float(description.body.depth_m or 0.0)
    for muscle in description.muscles:
        for key in ("fibre_stiffness_pa", REST_CONTRACTION):
            found[f"muscles.{muscle.name}.{key}"] = getattr(muscle, key)
    return found


def _materials(description: Description) -> dict[str, BaseModel]:
    """All materials by their path."""
    found: dict[str, BaseModel] = {"material.soft": description.material.soft}
    if description.material.spine is not None:
        found["material.spine"] = description.material.spine
    return found | {f"body.regions.{r.name}.material": r.material for r in description.body.regions}


def shared_constants(description: Description) -> dict[str, list[str]]:
    """What all materials have in common, such as one density, by its path: the paths of it in each of them."""
    found, materials = {}, _materials(description)
    for key in type(materials["material.soft"]).model_fields if len(materials) > 1 else ():
        if len({getattr(material, key) for material in materials.values()}) == 1:
            found[f"material.{key}"] = [f"{path}.{key}" for path in materials]
    return found


def shape_constants(description: Description) -> dict[str, float]:
    """Those of the body's outline or height, and of its spine and fin."""
    body, found = description.body, {}
    if body.outline is None:
        found["body.height_m"] = float(body.height_m or 0.0)
    else:
        found["body.outline.largest_half_height_m"] = body.outline.largest_half_height_m
        found |= dict(zip(outline_names(body), body.coefficients, strict=True))
    if body.spine is not None:
        found["body.spine.thickness_m"] = body.spine.thickness_m
        if body.spine.fin_length_m > 0:
            found["body.spine.fin_length_m"] = body.spine.fin_length_m
    return found


def outline_names(body: Body) -> tuple[str, ...]:
    """How the outline's coefficients are called; none for a body of one height."""
    count = 0 if body.outline is None else len(body.coefficients)
    return tuple(f"body.outline.coefficients.{index}" for index in range(count))


def _collect(section: BaseModel | None, path: str, found: dict[str, float]) -> None:
    if section is not None:
        found |= {f"{path}.{key}": float(getattr(section, key)) for key in type(section).model_fields}


def unit_of(path: str) -> str:
    """The SI unit that a path's last key ends in; "1" for a pure number."""
    return next((unit for ending, unit in _UNITS.items() if path.endswith(ending)), "1")


_Section = TypeVar("_Section", bound=BaseModel)


def with_constants(description: Description, values: dict[str, float]) -> Description:
    """The description with other values at some paths, not validated again; what lies on the body moves with it.

    What materials have in common is set in all of them, before what is named of a single one.
    """
    body, known = description.body, shape_constants(description)
    shared = shared_constants(description)
    common = {path: values[key] for key, paths in shared.items() if key in values for path in paths}
    single = {path: value for path, value in values.items() if path not in shared}
    for path, value in (common | single).items():
        description = _changed(description, path.split("."), value)
    if any(values.get(path, value) != value for path, value in known.items()):
        return _carried(description, body)
    return description


def _carried(description: Description, before: Body) -> Description:
    """The description with markers, and regions along the fin, at the same places of a body of another shape."""
    after = description.body
    markers = {}
    for name, marker in description.markers.items():
        if not marker.fixed:
            ((x, y),) = moved_points(np.array([[marker.x_m, marker.y_m]]), before, after).tolist()
            marker = marker.model_copy(update={"x_m": x, "y_m": y})
        markers[name] = marker
    regions = []
    for region in after.regions:
        ends = moved_points(np.array([[region.from_m, 0.0], [region.to_m, 0.0]]), before, after)[
            :, 0
        ].tolist()
        regions.append(region.model_copy(update={"from_m": ends[0], "to_m": ends[1]}))
    body = after.model_copy(update={"regions": tuple(regions)})
    return description.model_copy(update={"markers": markers, "body": body})


def _changed(section: _Section, path: list[str], value: float) -> _Section:
    head, *rest = path
    old = getattr(section, head)
    if not rest:
        new = value
    elif isinstance(old, tuple) and len(rest) == 1:
        new = (*old[: int(rest[0])], value, *old[int(rest[0]) + 1 :])
    elif isinstance(old, tuple):
        new = tuple(_changed(part, rest[1:], value) if part.name == rest[0] else part for part in old)
    else:
        new = _changed(old, rest, value)
    return section.model_copy(update={head: new})
