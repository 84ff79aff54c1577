# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Files that somebody else names, such as over the network: those of one folder only."""

from pathlib import Path


def inside_folder(folder: str | Path, name: str) -> Path:
    """The file that `name` means, a path from the folder or an absolute one, with links followed.

    Raises ValueError for a name that is no file below the folder: one that leads out of it, is the folder, or no path.
    """
    try:
        root = Path(folder).expanduser().resolve()
        path = (root / Path(name).expanduser()).resolve()
    except (ValueError, RuntimeError, OSError) as error:
        raise ValueError(f"{name!r} is no file below {folder} ({error})") from error
    if root not in path.parents:
        raise ValueError(f"{name!r} is no file below {root}")
    return path
