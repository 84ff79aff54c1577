"""How long a user waits for a command that does little: any `--help`, and the comparison of a dozen short runs."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ament_index_python.packages import get_package_prefix, get_packages_with_prefixes

COMPARED = Path("data") / "unseen_rig" / "quadratic_drag"
HELP_BAR_S, COMPARE_BAR_S, MEMORY_BAR_MB = 0.5, 3.0, 300.0
_TRIALS = 3


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


def executables() -> list[Path]:
    """All installed ones of all packages of the stack."""
    packages = sorted(get_packages_with_prefixes().items())
    folders = (Path(prefix) / "lib" / package for package, prefix in packages if package.startswith("hasel_"))
    return [path for folder in folders for path in sorted(folder.glob("*")) if os.access(path, os.X_OK)]


def measure() -> bool:
    """Print both beside their bars; whether they are met."""
    every = executables()
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
    compare = Path(get_package_prefix("hasel_sysid")) / "lib" / "hasel_sysid" / "compare"
    with tempfile.TemporaryDirectory() as folder:
        used = least_used([compare, *runs, "--output", folder])
    print(
        f"compare of {len(runs)} runs: {used.seconds:.1f} s of processor time "
        f"{_beside(used.seconds, COMPARE_BAR_S, 's')}, {used.megabytes:.0f} MB "
        f"{_beside(used.megabytes, MEMORY_BAR_MB, 'MB')}"
    )
    return slowest <= HELP_BAR_S and used.seconds <= COMPARE_BAR_S and used.megabytes <= MEMORY_BAR_MB


def _beside(value: float, bar: float, unit: str) -> str:
    return f"(bar {bar:g} {unit}: {'met' if value <= bar else 'MISSED'})"
