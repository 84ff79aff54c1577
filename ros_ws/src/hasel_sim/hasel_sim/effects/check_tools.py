"""What the checks of an effect share: the one sentence, a guarded call, and equality up to round-off."""

import numpy as np

from hasel_sim.effects.base import Effect
from hasel_sim.errors import ModelError


def expect(right: object, effect: Effect, found: str, change: str) -> None:
    """Raise ModelError "effect X found; change" unless right."""
    if not right:
        raise ModelError(f"effect '{effect.source or effect.id}' {found}: {change}")


def called(effect: Effect, method: str, shape: tuple[int, ...], *arguments) -> np.ndarray:
    """What a method returns, as an array of the shape expected and of finite numbers."""
    try:
        result = np.asarray(getattr(effect, method)(*arguments), dtype=float)
    except Exception as error:  # noqa: BLE001  a user's method may fail in any way
        expect(False, effect, f"fails in {method} ({type(error).__name__}: {error})", "correct that method")
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
    return result


def same(a: np.ndarray, b: np.ndarray) -> bool:
    """Equal to round-off."""
    return bool(np.allclose(a, b, rtol=1e-12, atol=1e-12 * max(float(np.abs(b).max(initial=0.0)), 1e-300)))
