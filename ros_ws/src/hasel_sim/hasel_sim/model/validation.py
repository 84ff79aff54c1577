"""Turn a validation error into one sentence: what was found, what was expected, what to do."""

from pydantic import BaseModel, ValidationError

from hasel_sim.errors import nearest_name
from hasel_sim.model import description


def _fields(model: type[BaseModel] | None) -> list[str]:
    return list(model.model_fields) if model else []


_SECTIONS: dict[str, type[BaseModel]] = {
    "": description.Description,
    "swimmer": description.SwimmerBody,
    "rectangle": description.RectangleBody,
    "material": description.Materials,
    "soft": description.Material,
    "spine": description.Material,
    "muscle": description.Muscle,
    "markers": description.Markers,
    "head": description.Marker,
    "middle": description.Marker,
    "tail": description.Marker,
    "numerics": description.Numerics,
}


def sentence_for(error: ValidationError) -> str:
    """The first problem of a validation error, as a sentence."""
    problem = error.errors()[0]
    place = [str(part) for part in problem["loc"]]
    where = ".".join(part for part in place if part not in ("swimmer", "rectangle")) or "the file"
    if problem["type"] == "extra_forbidden":
        parent = place[-2] if len(place) > 1 else ""
        section = description.ParameterEntry if "parameters" in place else _SECTIONS.get(parent)
        return f"unknown key '{where}'; {nearest_name(place[-1], _fields(section))}: rename or remove it"
    if problem["type"] == "missing":
        return f"the key '{where}' is missing: add it"
    if problem["type"] == "value_error":
        return f"{where}: {problem['ctx']['error']}"
    found = problem.get("input")
    return f"{where} is {found!r}; {problem['msg'].replace('Input should be', 'expected')}: correct it"
