"""Where a report comes from: command, versions, date."""

import platform
import shlex
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from datetime import datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

_GIVEN: ContextVar[tuple[str, ...] | None] = ContextVar("given", default=None)
_PACKAGES = ("hasel_sysid", "hasel_sim", "hasel_recording", "numpy", "scipy", "numba")


@dataclass(frozen=True)
class Provenance:
    """command: that makes this again; versions: by package, Python's first; date: local, to the minute."""

    command: str
    versions: tuple[tuple[str, str], ...]
    date: str


def provenance() -> Provenance:
    """Of this process, now."""
    versions = [("Python", platform.python_version())]
    for name in _PACKAGES:
        try:
            versions.append((name, version(name)))
        except PackageNotFoundError:
            continue
    return Provenance(_command(), tuple(versions), datetime.now().astimezone().strftime("%Y-%m-%d %H:%M %Z"))


@contextmanager
def called_as(*words: str) -> Iterator[None]:
    """Within it, reports say this command: of a command that is called by another program and not typed."""
    token = _GIVEN.set(tuple(words))
    try:
        yield
    finally:
        _GIVEN.reset(token)


def _command() -> str:
    """As it was typed, `ros2 run` before an installed executable of a package."""
    given = _GIVEN.get()
    if given is not None:
        return shlex.join(["ros2", "run", *given])
    program, arguments = Path(sys.argv[0]), sys.argv[1:]
    installed = program.parent.parent.name == "lib" and program.parent.name.startswith("hasel_")
    called = ["ros2", "run", program.parent.name, program.name] if installed else [program.name]
    return shlex.join([*called, *arguments])
