# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Start an executable of a ROS 2 package, found through the ament index exactly as `ros2 run` finds it."""

import difflib
import os
import sys
from pathlib import Path

from ament_index_python.packages import PackageNotFoundError, get_package_prefix, get_packages_with_prefixes

USAGE = "usage: bin/ros2-run PACKAGE EXECUTABLE [ARGUMENT...]"


class LookUpError(Exception):
    """The package or the executable does not exist."""


def find_prefix(package: str) -> Path:
    """Return the install prefix of a package; raises LookUpError naming the nearest known package."""
    try:
        return Path(get_package_prefix(package))
    except (PackageNotFoundError, ValueError):
        nearest = difflib.get_close_matches(package, get_packages_with_prefixes(), n=1, cutoff=0.0)
        hint = f"did you mean {nearest[0]}?" if nearest else "run `make build` first."
        raise LookUpError(f"There is no package {package!r}: {hint}") from None


def executables(prefix: Path, package: str) -> list[str]:
    """Return the names of a package's executables, sorted."""
    folder = prefix / "lib" / package
    files = folder.iterdir() if folder.is_dir() else []
    return sorted(path.name for path in files if path.is_file() and os.access(path, os.X_OK))


def find_executable(package: str, name: str) -> Path:
    """Return the path of a package's executable; raises LookUpError listing those that exist."""
    prefix = find_prefix(package)
    known = executables(prefix, package)
    if name not in known:
        listing = f"it has {', '.join(known)}." if known else "it has none."
        raise LookUpError(f"Package {package} has no executable {name!r}: {listing}")
    return prefix / "lib" / package / name


def main(arguments: list[str]) -> None:
    """Replace this process with the executable, so that signals reach it and its exit code is ours."""
    if arguments[:1] in (["-h"], ["--help"]):
        print(USAGE)
        return
    if len(arguments) < 2:
        sys.exit(USAGE)
    try:
        path = find_executable(arguments[0], arguments[1])
    except LookUpError as error:
        sys.exit(str(error))
    os.execv(path, [str(path), *arguments[2:]])


if __name__ == "__main__":
    main(sys.argv[1:])
