# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Which parameters a model can have: numbers of its file that are freed, and those that every body with muscles has.

A number of the file is named by its path, such as `material.soft.youngs_modulus_pa`. What all materials of a body have
in common is one number besides, such as `material.density_kg_per_m3`: a body that was weighed has one density. Among
them are those of the body's shape. They move the nodes of the mesh that the file's own shape has, and with them markers
and whatever else lies on the fin: a simulation can then be differentiated by them.

The muscles have parameters for how fast they contract, an amplitude for every level of the drive or those of a law, and
an onset wherever the drive passes levels at which no amplitude is known.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np
from pydantic import BaseModel

from hasel_sim.drive.amplitudes import LARGEST_ONSET, AmplitudeTable
from hasel_sim.effects.base import DriveEffect, DriveStage, Effect
from hasel_sim.model.description import Description
from hasel_sim.model.muscle_law import law_parameters
from hasel_sim.model.sections import Body
from hasel_sim.parameter import Parameter


def moved_points(points: np.ndarray, before: Body, after: Body) -> np.ndarray:
    """Points [m] [n, 2] of one body at the same places of another, of the same length.

    Along the body x stays, along the fin it keeps its share of the fin; across, a point keeps its share of the spine's
    half thickness, or of the soft half between the spine and the outline. Continuous, and linear within each part.
    """
    x, y = np.asarray(points, dtype=float).T
    length = before.length_m
    fins = [body.whole_length_m - length for body in (before, after)]
    stretch = fins[1] / fins[0] if fins[0] > 0 else 1.0
    behind = x > length
    spines = [0.5 * body.spine_thickness_m for body in (before, after)]
    heights = [body.half_heights(np.minimum(x, length) / length) for body in (before, after)]
    size = np.abs(y)
    within = size <= spines[0]
    in_spine = size * (spines[1] / spines[0] if spines[0] > 0 else 1.0)
    share = (size - spines[0]) / np.where(within, 1.0, heights[0] - spines[0])
    in_soft = spines[1] + share * (heights[1] - spines[1])
    across = np.sign(y) * np.where(within, in_spine, in_soft)
    return np.column_stack([np.where(behind, length + stretch * (x - length), x), across])


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


_AMPLITUDE_START = 0.04
"""Contraction at which the highest level of a drive is first tried."""
_START_VOLTAGE = 5500.0
"""Voltage [V] of a Peano-HASEL at which that contraction is a good first guess."""
_RESPONSES = {
    "sloped_box": (("slope", 0.5, "1/s", 0.02, 50.0),),
    "first_order": (("rise_time", 0.05, "s", 0.0, 2.0), ("fall_time", 0.05, "s", 0.0, 2.0)),
}


def response_parameters(description: Description) -> dict[str, Parameter]:
    """What a body with muscles always has besides its amplitudes: how fast the contraction follows, and its law's."""
    if not description.muscles:
        return {}
    response = {row[0]: Parameter(*row) for row in _RESPONSES[description.muscle_response]}
    return {**law_parameters(), **response} if description.muscle else response


def amplitude_parameters(
    tables: Iterable[AmplitudeTable],
    levels: np.ndarray | Sequence[float] | Mapping[str, np.ndarray],
    known: Mapping[str, Parameter],
) -> dict[str, Parameter]:
    """An amplitude of every table for each level, those that are known as they are.

    levels: of every channel in its SI unit, or by the name of a channel for those that contract alike.
    """
    found: dict[str, Parameter] = {}
    for table in tables:
        if isinstance(levels, Mapping):
            own = np.unique(np.concatenate([[], *(levels[c] for c in table.channels if c in levels)]))
        else:
            own = np.unique(levels)
        for level in own:
            name = table.name(level)
            highest = _START_VOLTAGE if table.unit == "V" else float(own[-1])
            start = Parameter(name, _AMPLITUDE_START * float(level) / highest, "1", 0.0, table.largest)
            found[name] = known.get(name, start)
    return found


def sweeps(description: Description, effects: Iterable[Effect]) -> bool:
    """Whether anything before the target lets the drive pass levels that nobody commanded."""
    return description.muscle_response == "first_order" or any(
        isinstance(effect, DriveEffect) and effect.sweeps and effect.stage < DriveStage.TARGET
        for effect in effects
    )


def onset_parameters(
    tables: Iterable[AmplitudeTable], parameters: Mapping[str, Parameter]
) -> dict[str, Parameter]:
    """One of every table with an amplitude; those that are known as they are, within what its levels allow.

    A new one is at 0, where the model is the same as without it.
    """
    found = {}
    for table in tables:
        levels = table.levels(parameters)
        if len(levels) == 0:
            continue
        new = Parameter(table.onset, 0.0, table.unit, 0.0)
        known, largest = parameters.get(table.onset, new), LARGEST_ONSET * float(levels[0])
        found[table.onset] = replace(known, value=min(known.value, largest), upper=min(known.upper, largest))
    return found
