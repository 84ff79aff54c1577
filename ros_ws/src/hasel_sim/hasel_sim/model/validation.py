"""Turn a validation error into one sentence: what was found, what was expected, what to do."""

from hasel_common.names import nearest_name
from pydantic import BaseModel, ValidationError

from hasel_sim.model import actuation, body, description, medium, muscle_law, pouch_section

_SECTIONS: dict[str, type[BaseModel]] = {
    "body": body.Body,
    "outline": body.Outline,
    "regions": body.BodyRegion,
    "tip_plate": body.TipPlate,
    "material": description.Materials,
    "soft": body.Material,
    "medium": medium.Medium,
    "channels": actuation.Channel,
    "muscles": actuation.MuscleRegion,
    "numerics": description.Numerics,
    "muscle": muscle_law.MuscleLaw,
    "pouch": pouch_section.PouchSection,
}
"""Sections by their key; `body.spine` and `material.spine`, and `material` within a region, are told apart below."""

_SCALES: tuple[dict[str, float], ...] = (
    {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6},
    {"pa": 1.0, "kpa": 1e3, "mpa": 1e6, "gpa": 1e9, "mbar": 1e2, "bar": 1e5},
    {"s": 1.0, "ms": 1e-3, "us": 1e-6},
)
"""Units in which a key may have been meant, by their size in the SI unit."""


def _section(parents: list[str], root: type[BaseModel]) -> type[BaseModel]:
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
    return _SECTIONS.get(parents[-1], root) if parents else root


def sentence_for(error: ValidationError, root: type[BaseModel] = description.Description) -> str:
    """The first problem of a validation error, as a sentence; a misspelt key goes before a missing one.

    root: what the whole file is.
    """
    problems = error.errors()
    strange = [each for each in problems if each["type"] == "extra_forbidden"]
    problem = strange[0] if problems[0]["type"] == "missing" and strange else problems[0]
    where = ".".join(str(part) for part in problem["loc"]) or "the file"
    if problem["type"] == "extra_forbidden":
        names = [part for part in problem["loc"] if isinstance(part, str)]
        return _strange_key(
            where, names[-1], list(_section(names[:-1], root).model_fields), problem.get("input")
        )
    if problem["type"] == "missing":
        return f"the key '{where}' is missing: add it"
    if problem["type"] == "value_error":
        place = "" if where == "the file" else f"{where}: "
        return f"{place}{problem['ctx']['error']}"
    found = problem.get("input")
    if problem["type"] == "model_type":
        names = [part for part in problem["loc"] if isinstance(part, str)]
        keys = ", ".join(_section(names, root).model_fields)
        return f"{where} is {found!r}; expected a section with keys of {keys}: write them below it"
    return f"{where} is {found!r}; {problem['msg'].replace('Input should be', 'expected')}: correct it"


def _strange_key(where: str, key: str, fields: list[str], value: object) -> str:
    """A key that is not known: the same one with another unit, or the nearest known one."""
    stem, _, unit = key.rpartition("_")
    for field in fields:
        same, _, expected = field.rpartition("_")
        scale = next((u[unit] / u[expected] for u in _SCALES if unit in u and expected in u), None)
        if stem == same and scale is not None and unit != expected:
            example = f", here {value * scale:g}" if isinstance(value, (int, float)) else ""
            return (
                f"unknown key '{where}'; the nearest known one is '{field}', in {expected}: rename it and convert the "
                f"value from {unit} to {expected}{example}"
            )
    return f"unknown key '{where}'; {nearest_name(key, fields)}: rename or remove it"
