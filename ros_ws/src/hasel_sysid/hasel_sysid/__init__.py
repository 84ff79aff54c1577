# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Compare the model with measurements, fit it, and learn which physical effect it lacks.

In Python: `import hasel_sysid as h`, then h.load, h.model, h.simulate, h.fit, h.diagnose, h.improve; they are listed in
docs/reference/python.md. The façade, `hasel_sysid.api`, is read when one of its names is first asked for: a command
imports only what it needs.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from hasel_common.provenance import lazy_version

if TYPE_CHECKING:
    from hasel_sysid.api import *  # noqa: F403


def __getattr__(name: str) -> Any:
    if name.startswith("_"):
        return lazy_version(__name__)(name)
    facade = import_module("hasel_sysid.api")
    if name not in facade.__all__:
        expected = ", ".join(facade.__all__)
        raise AttributeError(f"module 'hasel_sysid' has no attribute {name!r}; expected one of {expected}")
    return getattr(facade, name)


def __dir__() -> list[str]:
    return sorted({*globals(), *import_module("hasel_sysid.api").__all__})
