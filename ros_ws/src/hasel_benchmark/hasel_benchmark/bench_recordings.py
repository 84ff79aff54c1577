# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`bench_recordings`: `improve` for more and more recordings."""

import argparse
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from hasel_bringup.hidden_truth.plan import FITTED, UNSEEN, BoxRun
from hasel_common.measured_bar import MeasuredBar
from hasel_sim.parallel import executor

from hasel_benchmark.bench_hidden.hidden_cases import Case
from hasel_benchmark.bench_hidden.laboratory import measure
from hasel_benchmark.benchmark_commands import told
from hasel_benchmark.errors import BenchmarkError
from hasel_benchmark.process_cost import Watched, timed

CASE = Case("single", ("quadratic_drag",), 1.0, 203, "white", "near")
MOST_MEMORY_GB = 4.0
HEADING = (
    "| recordings | recorded, s | by the clock, s | processor time, s | a recorded second, s | memory, GB |\n"
    "|---|---|---|---|---|---|"
)
_SLOWEST_HZ, _STEP_HZ, _FREQUENCIES = 0.5, 0.1, 34


@dataclass(frozen=True)
class Cost:
    """recordings: how many were fitted; recorded_s: their length in all; wall_s: by the clock; processor_s: of all
    processes; memory_gb: the most that they took at once.
    """

    recordings: int
    recorded_s: float
    wall_s: float
    processor_s: float
    memory_gb: float


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; 0 if the bars are met, else 1. Raises BenchmarkError where it fails."""
    print(HEADING, flush=True)
    with tempfile.TemporaryDirectory() as folder:
        of_numbers = (
            cost(boxes(number), Path(folder) / str(number), options.jobs)
            for number in sorted(options.numbers)
        )
        bars = bars_of(told(of_numbers, options.json, line))
    for bar in bars:
        print(f"{bar.what}: {bar.measured:.2f} (bar: {bar.limit:g})")
    return int(not all(bar.met for bar in bars))


def boxes(number: int) -> list[BoxRun]:
    """So many runs over the voltages of the plan, from slow to fast. Raises BenchmarkError for what there is not."""
    voltages = sorted({box.voltage for box in FITTED})
    most = _FREQUENCIES * len(voltages)
    if not 1 <= number <= most:
        raise BenchmarkError(f"{number} recordings were asked for; expected 1 to {most}.")
    count = -(-number // len(voltages))
    places = np.linspace(0, _FREQUENCIES - 1, count).round()
    every = [BoxRun(v, float(_SLOWEST_HZ + _STEP_HZ * place)) for place in places for v in voltages]
    return every[:number]


def cost(fitted: Sequence[BoxRun], folder: Path, jobs: int | None) -> Cost:
    """Of one `improve` of such runs, and three that are not fitted."""
    with executor(1) as pool:
        measure(CASE, pool, switch_on_frames=True, fitted=fitted, unseen=UNSEEN).write(folder)
    given, unseen = (sorted(map(str, folder.glob(f"{kind}_*.csv"))) for kind in ("fit", "val"))
    where = ["--output", str(folder / "improve"), *(["--jobs", str(jobs)] if jobs else [])]
    with Watched() as watched:
        took = timed("hasel_sysid.command_line.improve", [*given, "--validate", *unseen, *where], lambda: 0.0)
    length = sum(float(np.ptp(box.run().time)) for box in fitted)
    return Cost(len(given), length, took.wall_s, watched.processor_s, watched.peak_bytes / 1e9)


def line(one: Cost) -> str:
    """A row below `HEADING`."""
    each = one.processor_s / one.recorded_s
    return (
        f"| {one.recordings} | {one.recorded_s:.0f} | {one.wall_s:.0f} | {one.processor_s:.0f} | {each:.2f} | "
        f"{one.memory_gb:.1f} |"
    )


def bars_of(costs: Sequence[Cost]) -> list[MeasuredBar]:
    """Processor time grows no faster than what was recorded, and the memory has room."""
    first, last = costs[0], costs[-1]
    growth = (last.processor_s / last.recorded_s) / (first.processor_s / first.recorded_s)
    return [
        MeasuredBar("a recorded second, of the most recordings over the fewest", growth, 1.0),
        MeasuredBar("memory of the most recordings, GB", last.memory_gb, MOST_MEMORY_GB),
    ]
