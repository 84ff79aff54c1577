"""Where a command's simulations run: on the cores that it may use, or on a cluster that has this code."""

import argparse
import os
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path

from hasel_sim.parallel import PACKAGES as SIMULATING
from hasel_sim.parallel import executor

PACKAGES = (*SIMULATING, "hasel_recording", "hasel_sysid")


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
