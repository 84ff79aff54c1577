"""`bench`: simulator, driver, tracker and the time to start, one after the other, beside their bars."""

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from ament_index_python.packages import PackageNotFoundError, get_package_prefix
from hasel_common.command_entry import command

from hasel_bringup import start_up
from hasel_bringup.errors import BringupError

PACKAGES = ("hasel_sim", "hasel_driver", "hasel_tracker_lab")


def bench_executable(package: str) -> Path:
    """Where a package's `bench` is installed. Raises BringupError when it is not."""
    try:
        path = Path(get_package_prefix(package)) / "lib" / package / "bench"
    except PackageNotFoundError:
        path = None
    if path is None or not path.is_file():
        raise BringupError(
            f"Package {package} has no executable bench; build the workspace with `make build`."
        )
    return path


@command
def main(arguments: Sequence[str] | None = None) -> int:
    """Run all; returns 0 if each reached its bars, 1 if one is missing, else the first other code."""
    given = sys.argv[1:] if arguments is None else list(arguments)
    if given:
        asked = given[0] in ("-h", "--help")
        print(
            "usage: bench (without arguments; for options run a package's own: ros2 run hasel_sim bench --help)",
            file=sys.stdout if asked else sys.stderr,
        )
        return 0 if asked else 2
    try:
        executables = [bench_executable(package) for package in PACKAGES]
    except BringupError as error:
        print(error, file=sys.stderr)
        return 1
    codes = []
    for package, executable in zip(PACKAGES, executables, strict=True):
        print(f"\n{package}", flush=True)
        codes.append(subprocess.run([executable], check=False).returncode)
    print("\nstart-up", flush=True)
    codes.append(int(not start_up.measure()))
    return next((code for code in codes if code), 0)


if __name__ == "__main__":
    sys.exit(main())
