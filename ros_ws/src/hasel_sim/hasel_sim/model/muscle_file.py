# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Muscle files: the pouch of a muscle on its bench, the effects it has, and what may be fitted."""

from collections.abc import Mapping
from dataclasses import replace
from importlib import resources
from pathlib import Path
from typing import Any

from hasel_common.names import nearest_name
from hasel_common.yaml_text import yaml_text
from pydantic import Field, ValidationError

from hasel_sim.errors import ModelError
from hasel_sim.model.muscle_law import PouchSection
from hasel_sim.model.sections import NotNegative, ParameterEntry, Section
from hasel_sim.model.validation import names_in, sections_of, sentence_for
from hasel_sim.muscle.muscle import POUCH, Muscle
from hasel_sim.parameter import Parameter

_FREE = {"relative_permittivity": ("1", 0.85, 1.15), "fill": ("1", 0.5, 1.5)}
"""Constants of a pouch that are never known well: unit, and bounds by the file's value."""


class MuscleDescription(Section):
    """A whole muscle file; mass_kg: of the muscle itself."""

    name: str
    pouch: PouchSection
    mass_kg: NotNegative = 0.0
    effects: tuple[str, ...] = ()
    parameters: dict[str, ParameterEntry] = Field(default_factory=dict)


def muscle_names() -> list[str]:
    """Names of the muscles that come with the package."""
    return names_in("muscle/muscles")


def load_muscle(name_or_path: str | Path) -> Muscle:
    """Read a muscle by the name of one that comes with the package, or from a file.

    Raises ModelError with one sentence about what is wrong.
    """
    name, path = str(name_or_path), Path(name_or_path)
    if name in muscle_names():
        text = (resources.files("hasel_sim") / "muscle" / "muscles" / f"{name}.yaml").read_text()
    elif path.is_file():
        text = path.read_text(encoding="utf-8", errors="replace")
    else:
        raise ModelError(
            f"there is no muscle '{name}'; expected a muscle file or the name of one, "
            f"{nearest_name(name, muscle_names())}"
        )
    return _parse(text, name)


def _parse(text: str, source: str) -> Muscle:
    keys = ", ".join(MuscleDescription.model_fields)
    content = sections_of(text, source, f"no muscle; expected the keys {keys}")
    try:
        return muscle_of(MuscleDescription.model_validate(content))
    except ValidationError as error:
        raise ModelError(f"{source}: {sentence_for(error, MuscleDescription)}") from None
    except ModelError as error:
        raise ModelError(f"{source}: {error}") from None


def muscle_of(description: MuscleDescription) -> Muscle:
    """The muscle that a description speaks of; the film's permittivity and the fill are free unless it says not."""
    pouch = description.pouch.pouch
    bare = Muscle(description.name, pouch, description.pouch.count, description.mass_kg)
    constants = {}
    for key, (unit, lower, upper) in _FREE.items():
        value = getattr(pouch, key)
        name = f"{POUCH}{key}"
        constants[name] = Parameter(name, value, unit, lower * value, upper * value)
    muscle = replace(bare, parameters=constants).with_effects(*description.effects)
    return replace(muscle, parameters=muscle.parameters | _given(description.parameters, muscle.parameters))


def _given(entries: Mapping[str, ParameterEntry], known: Mapping[str, Parameter]) -> dict[str, Parameter]:
    given = {}
    for name, entry in entries.items():
        if name not in known:
            raise ModelError(f"unknown parameter '{name}'; {nearest_name(name, known)}: rename or remove it")
        old = known[name]
        if entry.unit not in (None, old.unit):
            raise ModelError(
                f"{name} is given in '{entry.unit}'; expected '{old.unit}': convert value and bounds"
            )
        value, lower, upper = (
            old_one if new is None else new
            for new, old_one in ((entry.value, old.value), (entry.lower, old.lower), (entry.upper, old.upper))
        )
        if not lower <= value <= upper:
            raise ModelError(
                f"{name} is {value:g}; expected a value between its bounds {lower:g} and {upper:g}: correct one of them"
            )
        if entry.correlations:
            raise ModelError(
                f"{name} is given correlations; a muscle file keeps none, expected standard_error alone: remove them"
            )
        given[name] = Parameter(name, value, old.unit, lower, upper, entry.free, entry.standard_error)
    return given


def muscle_text(muscle: Muscle) -> str:
    """The muscle file that `load_muscle` reads back to the same muscle."""
    content = {
        "name": muscle.name,
        "pouch": _pouch(muscle),
        "mass_kg": muscle.mass,
        "effects": [effect.id for effect in muscle.effects],
        "parameters": {name: _entry(parameter) for name, parameter in muscle.parameters.items()},
    }
    return yaml_text(content)


def law_content(muscle: Muscle) -> dict[str, Any]:
    """The muscle section of a model file whose muscles are like this one, with the fitted constants in its pouch."""
    freed = {
        name.removeprefix(POUCH): value for name, value in muscle.values.items() if name.startswith(POUCH)
    }
    effects: dict[str, dict[str, float]] = {}
    for effect in muscle.effects:
        if not effect.in_time:
            effects[effect.id] = {p.name: muscle.values[f"{effect.id}.{p.name}"] for p in effect.parameters}
    return {"law": "peano_hasel", "pouch": {**_pouch(muscle), **freed}, "effects": effects}


def _pouch(muscle: Muscle) -> dict[str, Any]:
    keys = [key for key in PouchSection.model_fields if key != "count"]
    return {"count": muscle.count} | {key: getattr(muscle.pouch, key.removesuffix("_m")) for key in keys}


def _entry(p: Parameter) -> dict[str, Any]:
    entry = {"value": p.value, "unit": p.unit, "lower": p.lower, "upper": p.upper, "free": p.free}
    return entry if p.standard_error is None else {**entry, "standard_error": p.standard_error}
