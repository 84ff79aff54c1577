# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`bench`: simulator, driver, tracker and the time to start, one after the other, beside their bars.

The last is how long a user waits for a command that does little: any `--help`, and a comparison of a dozen short runs.
"""

import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ament_index_python.packages import get_packages_with_prefixes
from hasel_common.command_entry import command

from hasel_bringup.errors import BringupError
from hasel_bringup.processes import executable

PACKAGES = ("hasel_sim", "hasel_driver", "hasel_tracker_lab")
COMPARED = Path("data") / "unseen_rig" / "quadratic_drag"
HELP_BAR_S, COMPARE_BAR_S, MEMORY_BAR_MB = 0.5, 3.0, 300.0
_TRIALS = 3


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
    for package, path in zip(PACKAGES, executables, strict=True):
        print(f"\n{package}", flush=True)
        codes.append(subprocess.run([path], check=False).returncode)
    print("\nstart-up", flush=True)
    codes.append(int(not measure_start_up()))
    return next((code for code in codes if code), 0)


def bench_executable(package: str) -> Path:
    """Where a package's `bench` is installed. Raises BringupError when it is not."""
    try:
        return executable(package, "bench")
    except BringupError:
        raise BringupError(
            f"Package {package} has no executable bench; build the workspace with `make build`."
        ) from None


@dataclass(frozen=True)
class Used:
    """What a process used: processor time, of all its threads and of the kernel for it, and memory at most."""

    seconds: float
    megabytes: float


def used_by(command: Sequence[str | Path]) -> Used:
    """Run a command to its end, its output thrown away. Raises CalledProcessError when it fails."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, command)
    return Used(usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)


def least_used(command: Sequence[str | Path]) -> Used:
    """Of three runs: other processes make a run slower, never faster."""
    return min((used_by(command) for _ in range(_TRIALS)), key=lambda used: used.seconds)


def measure_start_up() -> bool:
    """Print time to help and time to compare beside their bars; whether they are met."""
    packages = sorted(get_packages_with_prefixes().items())
    folders = (Path(prefix) / "lib" / package for package, prefix in packages if package.startswith("hasel_"))
    every = [path for folder in folders for path in sorted(folder.glob("*")) if os.access(path, os.X_OK)]
    slowest, path = max((least_used([path, "--help"]).seconds, path) for path in every)
    print(
        f"--help, slowest of {len(every)}: {slowest:.2f} s of processor time, {path.parent.name} {path.name}"
        f" {_beside(slowest, HELP_BAR_S, 's')}"
    )
    runs = sorted(COMPARED.glob("*.csv"))
    if not runs:
        print(
            f"There are no recordings in {COMPARED}: run the benchmark from the clone's root.",
            file=sys.stderr,
        )
        return False
    with tempfile.TemporaryDirectory() as folder:
        used = least_used([executable("hasel_sysid", "compare"), *runs, "--output", folder])
    print(
        f"compare of {len(runs)} runs: {used.seconds:.1f} s of processor time "
        f"{_beside(used.seconds, COMPARE_BAR_S, 's')}, {used.megabytes:.0f} MB "
        f"{_beside(used.megabytes, MEMORY_BAR_MB, 'MB')}"
    )
    return slowest <= HELP_BAR_S and used.seconds <= COMPARE_BAR_S and used.megabytes <= MEMORY_BAR_MB


def _beside(value: float, bar: float, unit: str) -> str:
    return f"(bar {bar:g} {unit}: {'met' if value <= bar else 'MISSED'})"


if __name__ == "__main__":
    sys.exit(main())
