"""Model files: reading with one-sentence errors, and writing."""

import json
from importlib import resources
from pathlib import Path

from pydantic import ValidationError
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from hasel_sim.errors import ModelError, nearest_name
from hasel_sim.model.description import Description
from hasel_sim.model.model import Model
from hasel_sim.model.parameter import Parameter
from hasel_sim.model.validation import sentence_for


def model_names() -> list[str]:
    """Names of the models that come with the package."""
    folder = resources.files("hasel_sim") / "models"
    return sorted(
        entry.name.removesuffix(".yaml") for entry in folder.iterdir() if entry.name.endswith(".yaml")
    )


def load_model(name_or_path: str | Path) -> Model:
    """Read a model by the name of one that comes with the package, or from a file.

    Raises ModelError with one sentence for a missing file, an unknown key (with the nearest known one) or a bad value.
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
    return _parse(text, name, path.parent)


def _parse(text: str, source: str, folder: Path) -> Model:
    try:
        content = YAML(typ="safe").load(text)
    except YAMLError as error:
        raise ModelError(
            f"{source} is not valid YAML: {' '.join(str(error).split())}; correct that line"
        ) from None
    if not isinstance(content, dict):
        raise ModelError(f"{source} holds no model; expected keys such as name, body, material and markers")
    try:
        description = Description.model_validate(content)
    except ValidationError as error:
        raise ModelError(f"{source}: {sentence_for(error)}") from None
    parameters = {
        name: Parameter(
            name,
            entry.value,
            entry.unit,
            -float("inf") if entry.lower is None else entry.lower,
            float("inf") if entry.upper is None else entry.upper,
            entry.free,
            entry.standard_error,
        )
        for name, entry in description.parameters.items()
    }
    bare = Model(description.model_copy(update={"effects": (), "parameters": {}}))
    model = bare.with_effects(*(_located(effect, folder) for effect in description.effects))
    known = {"slope", *model.parameters}
    for name in parameters:
        if name not in known and not _is_amplitude(name):
            raise ModelError(f"{source}: unknown parameter '{name}'; {nearest_name(name, known)}")
        unit = model.parameters[name].unit if name in model.parameters else "1/s" if name == "slope" else "1"
        if parameters[name].unit != unit:
            raise ModelError(
                f"{source}: {name} is given in '{parameters[name].unit}'; expected '{unit}': convert value and bounds"
            )
    return Model(model.description, model.effects, {**model.parameters, **parameters})


def _located(effect: str, folder: Path) -> str:
    """An effect in a file is named relative to the model file."""
    path, separator, name = effect.rpartition(":")
    return effect if not separator or Path(path).is_absolute() else f"{(folder / path).resolve()}:{name}"


def _is_amplitude(name: str) -> bool:
    try:
        return name.startswith("amplitude_") and float(name.removeprefix("amplitude_")) > 0
    except ValueError:
        return False


def save_model(model: Model, path: str | Path) -> None:
    """Write a model file that `load_model` reads back to the same model."""
    content = json.loads(model.description.model_dump_json(exclude_none=True))
    content["effects"] = [effect.id if effect.source is None else effect.source for effect in model.effects]
    content["parameters"] = {name: _entry(parameter) for name, parameter in model.parameters.items()}
    yaml = YAML(typ="safe")
    yaml.sort_base_mapping_type_on_output = False
    yaml.default_flow_style = False
    with Path(path).open("w") as file:
        yaml.dump(content, file)


def _entry(parameter: Parameter) -> dict:
    entry: dict = {"value": parameter.value, "unit": parameter.unit}
    if parameter.lower > -float("inf"):
        entry["lower"] = parameter.lower
    if parameter.upper < float("inf"):
        entry["upper"] = parameter.upper
    entry["free"] = parameter.free
    if parameter.standard_error is not None:
        entry["standard_error"] = parameter.standard_error
    return entry
