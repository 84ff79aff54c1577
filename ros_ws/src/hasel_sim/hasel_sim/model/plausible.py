"""Numbers of a model file that no planar soft body has: mostly a unit that was mistaken."""

import re
from collections.abc import Iterator
from typing import Any

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
