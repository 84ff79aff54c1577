"""What the checks of an effect share: the one sentence, a call whose result is looked at, and equality to round-off."""

from collections.abc import Collection
from copy import deepcopy

import numpy as np

from hasel_sim.effects.base import Effect, ForceEffect, MaterialEffect
from hasel_sim.effects.guarded import guarded
from hasel_sim.errors import ModelError


def expect(right: object, effect: Effect, found: str, change: str) -> None:
    """Raise ModelError "effect X found; change" unless right."""
    if not right:
        raise ModelError(f"effect '{effect.source or effect.id}' {found}: {change}")


def check_depends_on(effect: ForceEffect | MaterialEffect, known: Collection[str]) -> None:
    """Refuse a depends_on that is no tuple, or that names what is not known."""
    given, names = effect.depends_on, ", ".join(known)
    expect(
        isinstance(given, (tuple, list)),
        effect,
        f"has depends_on = {given!r}, where a tuple of names is expected",
        f"name some of {names} in it, such as ({next(iter(known))!r},) with its comma",
    )
    unknown = [name for name in given if name not in known]
    expect(not unknown, effect, f"depends on {unknown}", f"name some of {names} in depends_on")


def called(effect: Effect, method: str, shape: tuple[int, ...], *arguments) -> np.ndarray:
    """What a method returns, as an array of the shape expected and of finite numbers, the same at every call."""
    result, again = (np.asarray(guarded(effect, method, *deepcopy(arguments)), dtype=float) for _ in range(2))
    expect(
        result.shape == shape,
        effect,
        f"returns shape {result.shape} from {method} where {shape} is expected",
        "return one row per row that comes in",
    )
    expect(
        np.isfinite(result).all(),
        effect,
        f"returns numbers that are not finite from {method}",
        "avoid division by zero and roots or logarithms of negative numbers",
    )
    repeatable(effect, method, np.array_equal(result, again))
    return result


def repeatable(effect: Effect, method: str, same_again: bool) -> None:
    """Refuse an effect whose method answered otherwise when called with the same input again."""
    expect(
        same_again,
        effect,
        f"returns other numbers from {method} when it is called with the same input again",
        "take random numbers, and anything it keeps from call to call, out of it",
    )


def same(a: np.ndarray, b: np.ndarray) -> bool:
    """Equal to round-off."""
    return bool(np.allclose(a, b, rtol=1e-12, atol=1e-12 * max(float(np.abs(b).max(initial=0.0)), 1e-300)))
