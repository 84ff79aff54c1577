"""Compare the model with measurements, fit it, and learn which physical effect it lacks.

In Python: `import hasel_sysid as h`, then h.load, h.model, h.simulate, h.fit, h.diagnose, h.improve; docs/api.md lists
all of it. The façade is read when one of its names is first asked for, so that a command imports only what it needs.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hasel_sysid.api import (
        Diagnosed,
        Fitted,
        Improved,
        Recordings,
        Simulated,
        diagnose,
        fit,
        improve,
        load,
        model,
        save,
        simulate,
    )

__all__ = [
    "Diagnosed",
    "Fitted",
    "Improved",
    "Recordings",
    "Simulated",
    "diagnose",
    "fit",
    "improve",
    "load",
    "model",
    "save",
    "simulate",
]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(
            f"module 'hasel_sysid' has no attribute {name!r}; expected one of {', '.join(__all__)}"
        )
    return getattr(import_module("hasel_sysid.api"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
