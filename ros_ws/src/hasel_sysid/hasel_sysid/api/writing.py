"""Files that Python's user asks for, with one sentence where they cannot be written."""

from collections.abc import Callable
from pathlib import Path

from hasel_common.command_entry import of_system

from hasel_sysid.errors import SysidError


def path_of(given: str | Path) -> Path:
    """The path itself. Raises SysidError for what is none."""
    if isinstance(given, (str, Path)):
        return Path(given)
    raise SysidError(
        f"found a {type(given).__name__} where a path is expected: give one such as 'model.yaml'"
    )


def written(path: Path, write: Callable[[Path], object]) -> Path:
    """The path, after `write` was called with it. Raises SysidError for what the system refused."""
    try:
        write(path)
    except OSError as error:
        raise SysidError(of_system(error)) from None
    return path
