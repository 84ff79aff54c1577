# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What every command does alike: one sentence per error, an exit code, its cores, results for other programs."""

import argparse
import json
import math
import os
import sys
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Any, TextIO

import numpy as np
from hasel_common.command_entry import in_a_sentence
from hasel_recording import RecordingError, RecordingWarning
from hasel_sim.errors import HaselSimError
from hasel_sim.parallel import PACKAGES as SIMULATING
from hasel_sim.parallel import executor

from hasel_sysid.errors import SysidError

MISLEADING = 3
PACKAGES = (*SIMULATING, "hasel_recording", "hasel_sysid")


def run_command(work: Callable[[], int | None]) -> int:
    """Run a command; its exit code is what `work` returns or 0, 2 after an error told on stderr, 130 after Ctrl-C."""
    with warnings.catch_warnings():
        warnings.simplefilter("always", RecordingWarning)
        warnings.showwarning = _show_warning
        return in_a_sentence(work, (HaselSimError, SysidError, RecordingError))


def told(work: Callable[[argparse.Namespace], int | None]) -> Callable[[argparse.Namespace], int]:
    """What a command does with its options, run by `run_command`."""

    @wraps(work)
    def run(options: argparse.Namespace) -> int:
        return run_command(lambda: work(options))

    return run


def _show_warning(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    print(f"warning: {message}", file=sys.stderr)


def write_json(content: dict[str, Any], path: Path) -> None:
    """Write a JSON file; NaN and infinity, which JSON does not know, become null."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(_plain(content), indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, np.generic):
        return _plain(value.item())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value


@contextmanager
def workers(options: argparse.Namespace, jobs: int | None = None) -> Iterator[Executor]:
    """The executor of --jobs or --scheduler; jobs: in place of one per core where neither is given.

    Raises ClusterError for a cluster without workers or without this code.
    """
    with executor(options.jobs or jobs or usable_cores(), options.scheduler, PACKAGES) as pool:
        yield pool


def usable_cores() -> int:
    """How many cores this process may use: by taskset, SLURM and a container's quota, not how many the machine has."""
    counts = [str(len(os.sched_getaffinity(0))), os.environ.get("SLURM_CPUS_PER_TASK", ""), _quota()]
    return max(1, min(int(count) for count in counts if count.isdecimal()))


def _quota() -> str:
    """Whole cores of the control group's quota; '' where there is none."""
    try:
        quota, period = Path("/sys/fs/cgroup/cpu.max").read_text(encoding="ascii").split()
    except (OSError, ValueError):
        return ""
    return str(max(1, int(quota) // int(period))) if quota.isdecimal() else ""
