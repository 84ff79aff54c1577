"""Turn a validation error into one sentence: what was found, what was expected, what to do."""

from pydantic import BaseModel, ValidationError

from hasel_sim.errors import nearest_name
from hasel_sim.model import actuation, body, description

_SECTIONS: dict[str, type[BaseModel]] = {
    "": description.Description,
    "body": body.Body,
    "outline": body.Outline,
    "regions": body.BodyRegion,
    "tip_plate": body.TipPlate,
    "material": description.Materials,
    "soft": body.Material,
    "channels": actuation.Channel,
    "muscles": actuation.Muscle,
    "numerics": description.Numerics,
}
"""Sections by their key; `body.spine` and `material.spine`, and `material` within a region, are told apart below."""


def _section(parents: list[str]) -> type[BaseModel]:
    if parents[:1] == ["parameters"]:
        return description.ParameterEntry
    if parents[:1] == ["markers"]:
        return description.Marker
    if parents == ["body", "spine"]:
        return body.Spine
    if parents[-1:] in (["spine"], ["soft"]) or (
        parents[:2] == ["body", "regions"] and parents[-1] == "material"
    ):
        return body.Material
    return _SECTIONS.get(parents[-1] if parents else "", description.Description)


def sentence_for(error: ValidationError) -> str:
    """The first problem of a validation error, as a sentence."""
    problem = error.errors()[0]
    where = ".".join(str(part) for part in problem["loc"]) or "the file"
    if problem["type"] == "extra_forbidden":
        names = [part for part in problem["loc"] if isinstance(part, str)]
        fields = list(_section(names[:-1]).model_fields)
        return f"unknown key '{where}'; {nearest_name(names[-1], fields)}: rename or remove it"
    if problem["type"] == "missing":
        return f"the key '{where}' is missing: add it"
    if problem["type"] == "value_error":
        place = "" if where == "the file" else f"{where}: "
        return f"{place}{problem['ctx']['error']}"
    found = problem.get("input")
    return f"{where} is {found!r}; {problem['msg'].replace('Input should be', 'expected')}: correct it"
