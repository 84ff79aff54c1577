# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What decides the answers of a process: its sources and the libraries that it computes with.

The source of this module is sent to workers as text, for they may lack this package: it needs only the standard
library.
"""

import hashlib
import sys
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path

LIBRARIES = ("distributed", "numba", "numpy", "scipy")
"""distributed is how two processes talk, numpy how arrays are sent; numba and scipy decide the last digits with it."""

MISSING = "missing"


def environment(packages: tuple[str, ...]) -> dict[str, str]:
    """For each package its version and a digest of its sources, and the release (two numbers) of every library.

    What is not there is `MISSING`. The release of Python is not asked: what is sent can be read by all that run this.
    """
    # what was read first is what was imported: sources that change under a process do not change what it does
    read = vars(sys).setdefault("hasel_sources_read", {})
    sources = {
        package: read.get(package) or read.setdefault(package, _package(package)) for package in packages
    }
    return sources | {library: ".".join(_version(library).split(".")[:2]) for library in LIBRARIES}


def _package(name: str) -> str:
    found = find_spec(name)
    if found is None or not found.submodule_search_locations:
        return MISSING
    folder = Path(next(iter(found.submodule_search_locations)))
    digest = hashlib.sha256()
    for path in sorted(path for path in folder.rglob("*") if path.suffix in (".py", ".yaml")):
        digest.update(str(path.relative_to(folder)).encode() + b"\0" + path.read_bytes() + b"\0")
    return f"{_version(name)} (sources {digest.hexdigest()[:8]})"


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return MISSING
