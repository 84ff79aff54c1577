"""Numbers of a model file that may be freed: named by their path, such as `material.soft.youngs_modulus_pa`."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from pydantic import BaseModel

if TYPE_CHECKING:
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
    """Every number that may be freed, by its path: of materials, regions, muscles, the tip plate and the medium."""
    found: dict[str, float] = {}
    for name in ("soft", "spine"):
        _collect(getattr(description.material, name), f"material.{name}", found)
    for region in description.body.regions:
        _collect(region.material, f"body.regions.{region.name}.material", found)
    _collect(description.body.tip_plate, "body.tip_plate", found)
    if description.medium is not None:
        for key in ("density_kg_per_m3", "viscosity_pa_s"):
            found[f"medium.{key}"] = getattr(description.medium, key)
        found["body.depth_m"] = float(description.body.depth_m or 0.0)
    for muscle in description.muscles:
        for key in ("fibre_stiffness_pa", REST_CONTRACTION):
            found[f"muscles.{muscle.name}.{key}"] = getattr(muscle, key)
    return found


def _collect(section: BaseModel | None, path: str, found: dict[str, float]) -> None:
    if section is not None:
        found |= {f"{path}.{key}": float(getattr(section, key)) for key in type(section).model_fields}


def unit_of(path: str) -> str:
    """The SI unit that a path's last key ends in; "1" for a pure number."""
    return next((unit for ending, unit in _UNITS.items() if path.endswith(ending)), "1")


_Section = TypeVar("_Section", bound=BaseModel)


def with_constants(description: Description, values: dict[str, float]) -> Description:
    """The description with other values at some paths, not validated again."""
    for path, value in values.items():
        description = _changed(description, path.split("."), value)
    return description


def _changed(section: _Section, path: list[str], value: float) -> _Section:
    head, *rest = path
    old = getattr(section, head)
    if not rest:
        new = value
    elif isinstance(old, tuple):
        new = tuple(_changed(part, rest[1:], value) if part.name == rest[0] else part for part in old)
    else:
        new = _changed(old, rest, value)
    return section.model_copy(update={head: new})
