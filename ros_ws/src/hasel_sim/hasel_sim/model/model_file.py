# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Model files: reading with one-sentence errors, those of the former kinds of body too, and writing."""

import json
import os
from collections.abc import Iterable
from dataclasses import replace
from importlib import resources
from pathlib import Path
from typing import Any

from hasel_common.names import nearest_name
from hasel_common.provenance import installed_version
from hasel_common.yaml_text import yaml_text
from pydantic import ValidationError

from hasel_sim.effects.base import Effect
from hasel_sim.errors import ModelError, OwnCodeError
from hasel_sim.model.description import Description
from hasel_sim.model.model import Model
from hasel_sim.model.model_parameters import constants, response_parameters, unit_of
from hasel_sim.model.muscle_file import law_content, load_muscle
from hasel_sim.model.muscle_law import MuscleLaw
from hasel_sim.model.sections import ParameterEntry
from hasel_sim.model.validation import implausible, names_in, sections_of, sentence_for
from hasel_sim.parameter import Parameter


def model_names() -> list[str]:
    """Names of the models that come with the package."""
    return names_in("models")


def load_model(name_or_path: str | Path, own_code: bool = True) -> Model:
    """Read a model by the name of one that comes with the package, or from a file.

    own_code: whether it may have effects of one's own, which are code that runs: False where nobody chose this model.
    Raises OwnCodeError where it has and may not, ModelError with one sentence for a missing file, an unknown key (with
    the nearest known one) or a bad value.
    """
    name = str(name_or_path)
    if name in model_names():
        text = (resources.files("hasel_sim") / "models" / f"{name}.yaml").read_text()
        return _parse(text, name, Path.cwd())
    path = Path(name)
    if not path.is_file():
        raise ModelError(
            f"there is no model '{name}'; expected a model file or the name of a model, "
            f"{nearest_name(name, model_names())}"
        )
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise ModelError(f"{name} is not a text file; expected a model file in YAML: give its path") from None
    return _parse(text, name, path.parent, own_code)


def _parse(text: str, source: str, folder: Path, own_code: bool = True) -> Model:
    content = sections_of(text, source, "no model; expected keys such as name, body, material and markers")
    try:
        description = Description.model_validate(translated(content) if is_former(content) else content)
    except ModelError as error:
        raise ModelError(f"{source}: {error}") from None
    except ValidationError as error:
        raise ModelError(f"{source}: {sentence_for(error)}") from None
    description = _with_muscle_file(description, folder, source)
    sections = ("body", "material", "medium", "muscles", "markers")
    for fault in implausible({name: content[name] for name in sections if name in content}):
        raise ModelError(f"{source}: {fault}")
    code = [effect for effect in description.effects if ":" in effect]
    if code and not own_code:
        raise OwnCodeError(f"{source} has the effect {code[0]}, which is code that would run")
    bare = description.model_copy(update={"effects": (), "parameters": {}})
    model = Model(bare, parameters=response_parameters(description)).with_effects(
        *(_located(effect, folder) for effect in description.effects)
    )
    freed = constants(description)
    given = {}
    for name, entry in description.parameters.items():
        known = model.parameters.get(name)
        if known is None and name in freed:
            known = Parameter(name, freed[name], unit_of(name))
        elif known is None and model.is_amplitude(name):
            known = Parameter(name, 0.0, "1")
        elif known is None and model.is_onset(name):
            known = Parameter(name, 0.0, model.onset_units[name], 0.0)
        if known is None:
            raise ModelError(f"{source}: unknown parameter '{name}'; {_nearest(name, model, freed)}")
        given[name] = _parameter(known, entry, freed.get(name), source)
    for name, entry in description.parameters.items():
        for other in entry.correlations:
            if other == name or other not in given:
                raise ModelError(
                    f"{source}: parameters.{name}.correlations names '{other}'; expected another of the file's "
                    f"parameters, {nearest_name(other, given)}"
                )
    return replace(model, parameters={**model.parameters, **given}).with_onsets()


def _with_muscle_file(description: Description, folder: Path, source: str) -> Description:
    """The description with what the muscle file says that it names; effects in time have no place in the law."""
    law = description.muscle
    if law is None or law.file is None:
        return description
    try:
        muscle = load_muscle(folder / law.file if (folder / law.file).is_file() else law.file)
    except ModelError as error:
        raise ModelError(f"{source}: muscle.file: {error}") from None
    return description.model_copy(update={"muscle": MuscleLaw.model_validate(law_content(muscle))})


def _nearest(name: str, model: Model, freed: Iterable[str]) -> str:
    meant = next(filter(None, (table.meant_by(name) for table in model.tables)), None)
    if meant:
        return f"an amplitude is named {meant}: rename it"
    return nearest_name(name, {*model.parameters, *freed})


def _parameter(known: Parameter, entry: ParameterEntry, constant: float | None, source: str) -> Parameter:
    """A parameter as the file gives it. Raises ModelError for another unit, or for a value that is not given."""
    if entry.unit is not None and entry.unit != known.unit:
        raise ModelError(
            f"{source}: {known.name} is given in '{entry.unit}'; expected '{known.unit}': convert value and bounds"
        )
    value = constant if entry.value is None else entry.value
    if value is None:
        raise ModelError(f"{source}: the key 'parameters.{known.name}.value' is missing: add it")
    lower = -float("inf") if entry.lower is None else entry.lower
    upper = float("inf") if entry.upper is None else entry.upper
    if not lower <= value <= upper:
        raise ModelError(
            f"{source}: {known.name} is {value:g}; expected a value between its bounds {lower:g} and {upper:g}: "
            "correct value or bounds"
        )
    error, correlations = entry.standard_error, dict(entry.correlations)
    return Parameter(known.name, value, known.unit, lower, upper, entry.free, error, correlations)


def _located(effect: str, folder: Path) -> str:
    """An effect in a file is named relative to the model file."""
    path, separator, name = effect.rpartition(":")
    return effect if not separator or Path(path).is_absolute() else f"{(folder / path).resolve()}:{name}"


def _named_from(folder: Path, effect: Effect) -> str:
    if effect.source is None:
        return effect.id
    path, _, name = effect.source.rpartition(":")
    return f"{Path(os.path.relpath(path, folder)).as_posix()}:{name}"


def save_model(model: Model, path: str | Path) -> None:
    """Write a model file that `load_model` reads back to the same model; effects in files are named relative to it."""
    content = _content(model, model.description, Path(path).resolve().parent)
    Path(path).write_text(
        f"# written by hasel_sim {installed_version('hasel_sim')}\n{yaml_text(content)}", encoding="utf-8"
    )


def model_text(model: Model, description: Description) -> str:
    """All that a model's file would say with another description, in one line; effects in files with their text."""
    content = _content(model, description, Path.cwd())
    return json.dumps([content, [effect.text for effect in model.effects]], sort_keys=True)


def _content(model: Model, description: Description, folder: Path) -> dict[str, Any]:
    content = json.loads(description.model_dump_json(exclude_none=True))
    content["effects"] = [_named_from(folder, effect) for effect in model.effects]
    content["parameters"] = {
        name: _entry(parameter, model.parameters) for name, parameter in model.parameters.items()
    }
    return content


def _entry(parameter: Parameter, names: Iterable[str]) -> dict[str, Any]:
    entry: dict[str, Any] = {"value": parameter.value, "unit": parameter.unit}
    if parameter.lower > -float("inf"):
        entry["lower"] = parameter.lower
    if parameter.upper < float("inf"):
        entry["upper"] = parameter.upper
    entry["free"] = parameter.free
    if parameter.standard_error is not None:
        entry["standard_error"] = parameter.standard_error
    correlations = {other: value for other, value in parameter.correlations.items() if other in names}
    if correlations:
        entry["correlations"] = correlations
    return entry


_LENGTHS = ("body_length_m", "fin_length_m", "spine_thickness_m", "largest_half_height_m")
_KEYS = {
    "swimmer": (*_LENGTHS, "outline_coefficients", "head_length_m", "muscle_end_m", "clamped"),
    "rectangle": ("length_m", "height_m", "clamped"),
}


def is_former(content: dict[str, Any]) -> bool:
    """Whether a file's content is of a former kind."""
    return isinstance(content.get("body"), dict) and "kind" in content["body"]


def translated(content: dict[str, Any]) -> dict[str, Any]:
    """The content as a file of today. Raises ModelError for what a file of its kind could not say."""
    content, body = dict(content), dict(content["body"])
    kind = body.pop("kind")
    if kind not in _KEYS:
        raise ModelError(
            f"body.kind is '{kind}'; expected swimmer or rectangle, or no kind and a body as of today: correct it"
        )
    for key in body:
        if key not in _KEYS[kind]:
            raise ModelError(
                f"unknown key 'body.{key}'; {nearest_name(key, _KEYS[kind])}: rename or remove it"
            )
    muscle = content.pop("muscle", None)
    numerics = dict(content.get("numerics", {}))
    numerics.setdefault("quadrature_order", 3)
    content["numerics"] = numerics
    if kind == "rectangle":
        if muscle is not None:
            raise ModelError(
                "a rectangle has no place for the section 'muscle'; expected muscles with channel, layer, from_m and "
                "to_m: describe them so and leave out body.kind"
            )
        return {**content, "body": body}
    missing = [key for key in _KEYS["swimmer"][:-1] if key not in body] + ["muscle"] * (muscle is None)
    if missing:
        raise ModelError(f"the key 'body.{missing[0]}' of a swimmer is missing: add it")
    content["body"] = {
        "length_m": body["body_length_m"],
        "outline": {
            "largest_half_height_m": body["largest_half_height_m"],
            "coefficients": body["outline_coefficients"],
        },
        "spine": {"thickness_m": body["spine_thickness_m"], "fin_length_m": body["fin_length_m"]},
    }
    sides = ("upper", "lower")
    content["channels"] = [{"name": side, "quantity": "voltage", "unit": "V"} for side in sides]
    places = {"from_m": body["head_length_m"], "to_m": body["muscle_end_m"]}
    content["muscles"] = [{"name": s, "channel": s, "layer": s, **places, **muscle} for s in sides]
    return content
