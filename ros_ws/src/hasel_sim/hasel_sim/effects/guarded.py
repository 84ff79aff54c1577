"""A call of what somebody else wrote: any failure of an effect's method is one of the effect, by its name."""

from typing import Any

from hasel_sim.effects.base import Effect
from hasel_sim.errors import HaselSimError, ModelError


def guarded(effect: Effect, method: str, *arguments: Any) -> Any:
    """What a method returns; any failure of it becomes a ModelError that names effect and method."""
    try:
        return getattr(effect, method)(*arguments)
    except HaselSimError:
        raise
    except Exception as error:
        raise ModelError(
            f"effect '{effect.source or effect.id}' fails in {method} ({type(error).__name__}: {error}): "
            "correct that method"
        ) from error
