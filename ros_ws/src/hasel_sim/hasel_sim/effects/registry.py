# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The catalogue: every effect whose file lies in one of the four folders, and effects in a user's own file."""

import importlib
import importlib.util
import pkgutil
import sys
from collections.abc import Container, Iterator
from functools import cache, lru_cache
from hashlib import sha256
from importlib.util import decode_source
from pathlib import Path
from types import ModuleType
from typing import TypeVar

from hasel_common.names import nearest_name

from hasel_sim import effects
from hasel_sim.effects.base import DriveEffect, Effect, ForceEffect, MaterialEffect, ObservationEffect
from hasel_sim.effects.check_effect import check_effect
from hasel_sim.errors import ModelError

_FOLDERS = ("drive", "material", "force", "observation")
_PLACES = (DriveEffect, ForceEffect, MaterialEffect, ObservationEffect)
Kind = TypeVar("Kind")


def load_own_effect(path: Path, kind: str, taken: Container[str] = ()) -> Effect:
    """The effect of class `kind` in a Python file; its id is the class's name unless it declares another.

    taken: ids that it must not have. Raises ModelError when the file or class is missing, or when the effect fails a
    check; the message says what to change.
    """
    if not path.is_file():
        raise ModelError(
            f"there is no file '{path}'; expected path/to/file.py:ClassName of an effect of your own: correct the path"
        )
    effect = rebuild_own_effect(str(path.resolve()), kind, _source(path))
    if effect.id in taken or not effect.id.isidentifier():
        raise ModelError(
            f"effect '{effect.source}' has the id '{effect.id}', which is taken or no plain name; expected one "
            "of its own: leave id out or choose another"
        )
    check_effect(effect)
    return effect


def _source(path: Path) -> str:
    """The file's text in the encoding that Python would take it to be in."""
    try:
        return decode_source(path.read_bytes())
    except (UnicodeDecodeError, SyntaxError) as error:
        raise ModelError(
            f"'{path}' is no text in UTF-8 ({error}); expected a Python file: save it in UTF-8, or name its encoding "
            "in the first line, such as # coding: latin-1"
        ) from error


@lru_cache(maxsize=64)
def rebuild_own_effect(path: str, kind: str, text: str) -> Effect:
    """The effect of class `kind` in a file's text; other processes and computers rebuild it from this."""
    module = _module(path, text)
    own = {name: value for name, value in vars(module).items() if _is_own_class(value, module)}
    if kind not in own:
        raise ModelError(
            f"'{path}' has no class '{kind}'; {nearest_name(kind, own)}: correct the name after ':'"
        )
    found = own[kind]
    if not issubclass(found, _PLACES):
        names = ", ".join(place.__name__ for place in _PLACES)
        raise ModelError(
            f"class '{kind}' in '{path}' is no effect; expected a subclass of one of {names}: derive it from one"
        )
    found.id, found.source, found.text = vars(found).get("id", kind), f"{path}:{kind}", text
    found.__reduce__ = lambda effect: (rebuild_own_effect, (path, kind, text))
    return found()


def _is_own_class(value: object, module: ModuleType) -> bool:
    return isinstance(value, type) and value.__module__ == module.__name__


def _module(path: str, text: str) -> ModuleType:
    module = ModuleType(f"own_effect_{sha256(f'{path}:{text}'.encode()).hexdigest()[:16]}")
    module.__file__ = path
    sys.modules[module.__name__] = module
    try:
        exec(compile(text, path, "exec"), vars(module))
    except Exception as error:
        line = f" in line {error.lineno}" if isinstance(error, SyntaxError) else ""
        raise ModelError(
            f"'{path}' cannot be run{line} ({type(error).__name__}: {error}); expected a Python file: correct it"
        ) from error
    return module


def kinds_in(package: ModuleType, base: type[Kind]) -> Iterator[type[Kind]]:
    """The subclasses of a class that the modules of a package define, in alphabetical order of these."""
    for name in sorted(module.name for module in pkgutil.iter_modules(package.__path__)):
        module = importlib.import_module(f"{package.__name__}.{name}")
        yield from (
            kind for kind in vars(module).values() if _is_own_class(kind, module) and issubclass(kind, base)
        )


@cache
def catalogue() -> dict[str, Effect]:
    """All built-in effects by id, in alphabetical order of place and id."""
    packages = [importlib.import_module(f"{effects.__name__}.{place}") for place in _FOLDERS]
    return {kind.id: kind() for package in packages for kind in kinds_in(package, Effect)}


def find_effects(names: tuple[str, ...]) -> tuple[Effect, ...]:
    """Effects by id, or by `path/to/file.py:ClassName`. Raises ModelError with the nearest known id."""
    return tuple(_found(name) for name in names)


def _found(name: str) -> Effect:
    path, is_own, kind = name.rpartition(":")
    if is_own:
        return load_own_effect(Path(path), kind, taken=catalogue())
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
