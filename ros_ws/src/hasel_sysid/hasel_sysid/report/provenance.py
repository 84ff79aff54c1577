"""Where a report comes from: command, versions, date."""

import platform
import shlex
import sys
from dataclasses import dataclass
from datetime import datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

_PACKAGES = ("hasel_sysid", "hasel_sim", "hasel_recording", "numpy", "scipy", "numba")


@dataclass(frozen=True)
class Provenance:
    """command: as it was typed; versions: by package, Python's first; date: local, to the minute."""

    command: str
    versions: tuple[tuple[str, str], ...]
    date: str


def provenance() -> Provenance:
    """Of this process, now."""
    program, *arguments = sys.argv
    command = shlex.join([Path(program).name, *arguments])
    versions = [("Python", platform.python_version())]
    for name in _PACKAGES:
        try:
            versions.append((name, version(name)))
        except PackageNotFoundError:
            continue
    return Provenance(command, tuple(versions), datetime.now().astimezone().strftime("%Y-%m-%d %H:%M %Z"))
