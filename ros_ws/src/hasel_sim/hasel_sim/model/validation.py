# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is wrong with a file, as one sentence: what was found, what was expected, what to do."""

import re
from collections.abc import Iterator
from importlib import resources
from typing import Any, get_args

from hasel_common.names import nearest_name
from hasel_common.yaml_text import YAMLError, read_yaml
from pydantic import BaseModel, ValidationError

from hasel_sim.errors import ModelError
from hasel_sim.model.description import Description

_SCALES: tuple[dict[str, float], ...] = (
    {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6},
    {"pa": 1.0, "kpa": 1e3, "mpa": 1e6, "gpa": 1e9, "mbar": 1e2, "bar": 1e5},
    {"s": 1.0, "ms": 1e-3, "us": 1e-6},
)
"""Units in which a key may have been meant, by their size in the SI unit."""


def _section(keys: list[str], root: type[BaseModel]) -> type[BaseModel]:
    """The section that keys lead to from a file's root; names of markers and parameters lead no farther."""
    for key in keys:
        known = root.model_fields.get(key)
        root = next(_sections_in(known.annotation), root) if known else root
    return root


def _sections_in(annotation: Any) -> Iterator[type[BaseModel]]:
    parts = get_args(annotation)
    if not parts and isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for part in parts:
        yield from _sections_in(part)


def names_in(folder: str) -> list[str]:
    """Names of the YAML files in a folder of this package."""
    found = (resources.files("hasel_sim") / folder).iterdir()
    return sorted(entry.name.removesuffix(".yaml") for entry in found if entry.name.endswith(".yaml"))


def sections_of(text: str, source: str, otherwise: str) -> dict[str, Any]:
    """What a file's text says. Raises ModelError where it is no YAML or no mapping, which `otherwise` tells."""
    try:
        content = read_yaml(text)
    except YAMLError as error:
        raise ModelError(
            f"{source} is not valid YAML: {' '.join(str(error).split())}; correct that line"
        ) from None
    if not isinstance(content, dict):
        raise ModelError(f"{source} holds {otherwise}")
    return content


def sentence_for(error: ValidationError, root: type[BaseModel] = Description) -> str:
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


_RANGES: dict[str, tuple[float, float, str]] = {
    "_m": (1e-6, 10.0, "m"),
    "_pa": (1.0, 1e12, "Pa"),
    "_pa_s": (1e-6, 1e3, "Pa s"),
    "medium.density_kg_per_m3": (0.01, 3e4, "kg/m^3"),
    "_kg_per_m3": (10.0, 3e4, "kg/m^3"),
    "_kg_per_m": (1e-9, 1e4, "kg/m"),
    "_time_s": (1e-9, 1e4, "s"),
    "_m_per_s2": (1e-6, 1e3, "m/s^2"),
}
"""Smallest and largest magnitude that is believed, by the end of a key; zero is always believed."""


def implausible(content: dict[str, Any]) -> Iterator[str]:
    """A sentence for every number of a model file's sections that lies outside the range of its unit."""
    for key, value in _numbers(content):
        name = re.sub(r"(\.\d+)+$", "", key)
        suffix = next((end for end in _RANGES if name.endswith(end)), None)
        if suffix is None or key.endswith("tolerance_m"):
            continue
        low, high, unit = _RANGES[suffix]
        if value != 0 and not low <= abs(value) <= high:
            yield f"{key} is {value:g} {unit}; expected {low:g} to {high:g} {unit}: give it in {unit}"


def _numbers(content: Any, at: str = "") -> Iterator[tuple[str, float]]:
    """Every number with its dotted key."""
    if isinstance(content, dict):
        for key, value in content.items():
            yield from _numbers(value, f"{at}.{key}" if at else str(key))
    elif isinstance(content, (list, tuple)):
        for number, value in enumerate(content):
            yield from _numbers(value, f"{at}.{number}")
    elif isinstance(content, (int, float)) and not isinstance(content, bool):
        yield at, float(content)
