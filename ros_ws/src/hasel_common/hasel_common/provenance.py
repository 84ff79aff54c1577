# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Which software, in which version: `__version__` of every package, and who made a recording."""

import os
import platform
from collections.abc import Callable, Iterable, Mapping
from datetime import datetime, timezone
from typing import Any

PREFIX = "recorded_by."  # of the header lines; what an experiment is about has none


def lazy_version(package: str) -> Callable[[str], str]:
    """What a package takes as its `__getattr__`; of a package that was not installed the version is "unknown"."""

    def attribute(name: str) -> str:
        if name != "__version__":
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        return installed_version(package)

    return attribute


def provenance(recorder: str, packages: Iterable[str], parameters: Mapping[str, Any]) -> dict[str, str]:
    """Return header lines: the recorder and packages with their versions, the time, and each parameter's value."""
    lines = {
        "node": recorder,
        "time": datetime.now(timezone.utc).isoformat(timespec="seconds"),
        "ros_distro": os.environ.get("ROS_DISTRO", "jazzy"),
        "python": platform.python_version(),
        **{f"version.{name}": installed_version(name) for name in packages},
        **{f"parameter.{name}": value for name, value in parameters.items()},
    }
    return {f"{PREFIX}{key}": str(value) for key, value in lines.items()}


def without_provenance(header: Mapping[str, str]) -> tuple[dict[str, str], str]:
    """Header lines but for those of `provenance`, and these in a sentence; it is empty where there are none."""
    made = {key.removeprefix(PREFIX): value for key, value in header.items() if key.startswith(PREFIX)}
    others = {key: value for key, value in header.items() if not key.startswith(PREFIX)}
    if not made:
        return others, ""
    recorder, when = made.get("node", "an unknown recorder"), made.get("time", "an unknown time")
    return others, f"by {recorder} at {when}; `info` lists versions and parameters, {len(made)} lines"


def installed_version(package: str) -> str:
    """Return a package's version, or "unknown" where it runs without having been installed."""
    from importlib.metadata import PackageNotFoundError, version  # takes as long to import as a whole package

    try:
        return version(package)
    except PackageNotFoundError:
        return "unknown"
