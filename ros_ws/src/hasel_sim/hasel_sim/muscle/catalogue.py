"""All effects of the muscle on its bench: one file each in `effects/`."""

import importlib
import inspect
import pkgutil
from functools import cache

from hasel_common.names import nearest_name

from hasel_sim.errors import ModelError
from hasel_sim.muscle import effects
from hasel_sim.muscle.effect import MuscleEffect


@cache
def muscle_catalogue() -> dict[str, MuscleEffect]:
    """The effects by id, in alphabetical order."""
    found: dict[str, MuscleEffect] = {}
    for name in sorted(module.name for module in pkgutil.iter_modules(effects.__path__)):
        module = importlib.import_module(f"{effects.__name__}.{name}")
        for kind in vars(module).values():
            own = inspect.isclass(kind) and kind.__module__ == module.__name__
            if own and issubclass(kind, MuscleEffect):
                found[kind.id] = kind()
    return found


def find_muscle_effects(names: tuple[str, ...]) -> tuple[MuscleEffect, ...]:
    """Effects by id. Raises ModelError with the nearest known one."""
    known = muscle_catalogue()
    for name in names:
        if name not in known:
            raise ModelError(
                f"unknown effect of a muscle '{name}'; {nearest_name(name, known)}: correct the name"
            )
    return tuple(known[name] for name in names)
