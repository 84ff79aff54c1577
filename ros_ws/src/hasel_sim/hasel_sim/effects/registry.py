"""The catalogue: every effect whose file lies in one of the four folders, and effects in a user's own file."""

import importlib
import importlib.util
import inspect
import pkgutil
from functools import cache
from pathlib import Path

from hasel_common.names import nearest_name

from hasel_sim import effects
from hasel_sim.effects.base import DriveEffect, Effect, ForceEffect, MaterialEffect, ObservationEffect
from hasel_sim.effects.own import load_own_effect
from hasel_sim.errors import ModelError

_PLACES = (DriveEffect, ForceEffect, MaterialEffect, ObservationEffect)


def _effects_in(module) -> list[type[Effect]]:
    found = [value for value in vars(module).values() if inspect.isclass(value) and issubclass(value, Effect)]
    return [value for value in found if value.__module__ == module.__name__ and not inspect.isabstract(value)]


@cache
def catalogue() -> dict[str, Effect]:
    """All built-in effects by id, in alphabetical order of place and id."""
    found: dict[str, Effect] = {}
    for place in ("drive", "material", "force", "observation"):
        package = importlib.import_module(f"{effects.__name__}.{place}")
        for name in sorted(module.name for module in pkgutil.iter_modules(package.__path__)):
            for kind in _effects_in(importlib.import_module(f"{package.__name__}.{name}")):
                found[kind.id] = kind()
    return found


def find_effects(names: tuple[str, ...]) -> tuple[Effect, ...]:
    """Effects by id, or by `path/to/file.py:ClassName`. Raises ModelError with the nearest known id."""
    return tuple(_own(name) if ":" in name else _built_in(name) for name in names)


def _built_in(name: str) -> Effect:
    if name.endswith(".py"):
        raise ModelError(
            f"'{name}' names a file and no class in it; expected path/to/file.py:ClassName: write {name}:CLASS, with "
            "the name of the effect's class"
        )
    if name not in catalogue():
        raise ModelError(
            f"unknown effect '{name}'; {nearest_name(name, catalogue())}; an effect of your own is named "
            "path/to/file.py:ClassName"
        )
    return catalogue()[name]


def _own(name: str) -> Effect:
    path, _, kind = name.rpartition(":")
    return load_own_effect(Path(path), kind, taken=catalogue())
