"""Where a command's simulations run: on the cores that it may use, or on a cluster that has this code."""

import argparse
import os
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path

from hasel_sim.parallel import executor

from hasel_sysid.errors import SysidError

PATIENCE_S = 10
_HAS_CODE = "__import__('importlib.util').util.find_spec('hasel_sim') is not None"


@contextmanager
def workers(options: argparse.Namespace, jobs: int | None = None) -> Iterator[Executor]:
    """The executor of --jobs or --scheduler; jobs: in place of one per core where neither is given.

    Raises SysidError for a cluster without workers or without this code.
    """
    if options.scheduler is not None:
        _check_cluster(options.scheduler)
    with executor(options.jobs or jobs or usable_cores(), options.scheduler) as pool:
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


def _check_cluster(address: str) -> None:
    from distributed import Client

    try:
        with Client(address, timeout="5s") as client:
            try:
                client.wait_for_workers(1, timeout=PATIENCE_S)
            except TimeoutError:
                raise SysidError(
                    f"the scheduler at {address} has no worker; start one with `dask worker {address}` in an "
                    "environment of this workspace (. setup/environment.bash)"
                ) from None
            without = [worker for worker, has in client.run(eval, _HAS_CODE).items() if not has]
    except (OSError, ValueError):
        return  # no scheduler: the executor says so
    if without:
        raise SysidError(
            f"{len(without)} workers of {address}, such as {without[0]}, have not got this code; start them in an "
            "environment of this workspace (. setup/environment.bash), of the same revision"
        )
