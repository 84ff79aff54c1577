# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`bench_cluster`: commands with one worker and with two, in turns."""

import argparse
import json
import os
import statistics
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from hasel_common.measured_bar import MeasuredBar

from hasel_benchmark.errors import BenchmarkError
from hasel_benchmark.process_cost import Took, timed

if TYPE_CHECKING:  # the command's options are read without it
    from distributed import Client

WORKERS = (1, 2)
BAR = 1.7
SWIMS = (
    *("--model", "swimmer_in_oil", "--voltage", "3500,4500,5500", "--frequency", "1:10:0.25"),
    *("--duration", "10"),
)


@dataclass(frozen=True)
class Work:
    """A command with its arguments, and what it took by the number of workers."""

    name: str
    module: str
    arguments: tuple[str, ...]
    took: Mapping[int, list[Took]] = field(default_factory=lambda: {count: [] for count in WORKERS})

    def bar(self) -> MeasuredBar:
        """How many times sooner two workers answer."""
        one, two = (statistics.median(took.wall_s for took in self.took[count]) for count in WORKERS)
        return MeasuredBar(f"{self.name}: two workers against one", one / two, BAR, True)


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; 0 if the answers are the same and the bars are met, else 1.

    Raises BenchmarkError where there are no recordings, where a command fails or answers otherwise than alone.
    """
    from distributed import Client, LocalCluster

    works = [_identification(options.recordings), Work("swim", "hasel_sim.commands.swim", SWIMS)]
    with ExitStack() as until_the_end:
        folder = Path(until_the_end.enter_context(tempfile.TemporaryDirectory()))
        clusters = {}
        for count in WORKERS:
            cluster = LocalCluster(
                n_workers=count, threads_per_worker=1, dashboard_address=None, host="127.0.0.1"
            )
            until_the_end.enter_context(cluster)
            clusters[count] = until_the_end.enter_context(Client(cluster))
        for work in works:
            alone = _answer(work, folder / work.name, ["--jobs", "1"], lambda: 0.0)[1]
            for number in range(options.rounds + 1):
                for count, client in clusters.items():
                    where = ["--scheduler", client.scheduler.address]
                    took, answer = _answer(
                        work, folder / f"{work.name}_{number}_{count}", where, _used_by(client)
                    )
                    if answer != alone:
                        raise BenchmarkError(
                            f"{work.name} answers otherwise with {count} workers than alone."
                        )
                    if number:  # the first only warms the workers
                        work.took[count].append(took)
            _print(work)
    if options.json:
        values = {
            work.name: {count: [asdict(took) for took in each] for count, each in work.took.items()}
            for work in works
        }
        options.json.write_text(json.dumps(values, indent=1))
    return int(not all(work.bar().met for work in works))


def _identification(folder: Path) -> Work:
    fitted, unseen = (sorted(map(str, folder.glob(f"{kind}_*.csv"))) for kind in ("fit", "val"))
    if not fitted or not unseen:
        raise BenchmarkError(
            f"{folder} has no fit_*.csv and val_*.csv; run this in the repository, or give --recordings DIR."
        )
    return Work("improve", "hasel_sysid.command_line.improve", (*fitted, "--validate", *unseen))


def _answer(
    work: Work, folder: Path, where: Sequence[str], of_workers: Callable[[], float]
) -> tuple[Took, str]:
    """What it took, and the answer as text."""
    folder.mkdir()
    path = folder / "answer.json"
    arguments = [*work.arguments, *where, "--output", str(folder), "--json", str(path)]
    took = timed(work.module, arguments, of_workers)
    return took, path.read_text()


def _used_by(client: "Client") -> Callable[[], float]:
    """Processor time of a cluster's workers until now [s]."""
    return lambda: sum(client.run(time.process_time).values())


def _print(work: Work) -> None:
    for count, each in work.took.items():
        wall = ", ".join(f"{took.wall_s:.1f}" for took in each)
        command, workers = (
            statistics.median(getattr(took, name) for took in each) for name in ("command_s", "workers_s")
        )
        print(
            f"{work.name}, workers: {count}: {wall} s; processor time {command:.1f} s of the command, "
            f"{workers:.1f} s of the workers"
        )
    bar = work.bar()
    print(
        f"{bar.what}: {bar.measured:.2f} times sooner (bar: {bar.limit:g}), the same answer; "
        f"{os.getloadavg()[0]:.1f} processes wanted one of {os.cpu_count()} cores",
        flush=True,
    )
