# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What the checks of an effect share: one sentence, a call whose result is looked at, equality to round-off, units."""

import re
from collections.abc import Collection
from copy import deepcopy
from functools import partial
from typing import Any

import numpy as np

from hasel_sim.effects.base import Effect, ForceEffect, MaterialEffect, guarded
from hasel_sim.errors import ModelError


def expect(effect: Effect, right: object, found: str, change: str) -> None:
    """Raise ModelError "effect X found; change" unless right."""
    if not right:
        raise ModelError(f"effect '{effect.source or effect.id}' {found}: {change}")


def check_depends_on(effect: ForceEffect | MaterialEffect, known: Collection[str]) -> None:
    """Refuse a depends_on that is no tuple, or that names what is not known."""
    must = partial(expect, effect)
    given, names = effect.depends_on, ", ".join(known)
    must(
        isinstance(given, (tuple, list)),
        f"has depends_on = {given!r}, where a tuple of names is expected",
        f"name some of {names} in it, such as ({next(iter(known))!r},) with its comma",
    )
    unknown = [name for name in given if name not in known]
    must(not unknown, f"depends on {unknown}", f"name some of {names} in depends_on")


def called(effect: Effect, method: str, shape: tuple[int, ...], *arguments: Any) -> np.ndarray:
    """What a method returns, as an array of the shape expected and of finite numbers, the same at every call."""
    must = partial(expect, effect)
    result, again = (np.asarray(guarded(effect, method, *deepcopy(arguments)), dtype=float) for _ in range(2))
    must(
        result.shape == shape,
        f"returns shape {result.shape} from {method} where {shape} is expected",
        "return one row per row that comes in",
    )
    must(
        np.isfinite(result).all(),
        f"returns numbers that are not finite from {method}",
        "avoid division by zero and roots or logarithms of negative numbers",
    )
    repeatable(effect, method, np.array_equal(result, again))
    return result


def repeatable(effect: Effect, method: str, same_again: bool) -> None:
    """Refuse an effect whose method answered otherwise when called with the same input again."""
    expect(
        effect,
        same_again,
        f"returns other numbers from {method} when it is called with the same input again",
        "take random numbers, and anything it keeps from call to call, out of it",
    )


def same(a: np.ndarray, b: np.ndarray) -> bool:
    """Equal to round-off."""
    return bool(np.allclose(a, b, rtol=1e-12, atol=1e-12 * max(float(np.abs(b).max(initial=0.0)), 1e-300)))


_PREFIXES = ("", "k", "M", "G", "m", "u", "µ", "n", "c", "h")
_BASES = ("m", "s", "g", "A", "K", "rad", "sr")
_DERIVED = ("N", "Pa", "J", "W", "V", "C", "F", "H", "S", "T", "Wb", "Hz", "Ohm", "Ω")
_OTHERS = ("1", "deg", "°", "°C", "%", "mol", "bar", "mbar", "min", "h", "px")
_KNOWN = {prefix + base for prefix in _PREFIXES for base in _BASES + _DERIVED} | set(_OTHERS)


def is_unit(text: str) -> bool:
    """Whether a text is a product or quotient of units, such as "kg/m^2", "N s/m", "1/s" or "m s⁻¹"."""
    words = re.split(r"[\s*·/().]+", text)
    found = [re.sub(r"(\^?[-+]?\d+|[⁻⁺]?[¹²³⁴])$", "", word) or word for word in words if word]
    return bool(found) and all(word in _KNOWN for word in found)
