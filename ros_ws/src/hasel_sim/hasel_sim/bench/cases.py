# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is timed, the default swimmer at 5.5 kV, 2 Hz; how, by processor time of one thread; and the bars beside it."""

import cProfile
import os
import pstats
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from hasel_common.measured_bar import MeasuredBar
from rich.table import Column, Table
from scipy.linalg import lapack

from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.model import Model, load_model
from hasel_sim.model_mesh import model_mesh
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

FRAMES_PER_SECOND = 120.0


def fitted_swimmer() -> Model:
    """The default swimmer with amplitudes and slope near those that fit a real one."""
    model = load_model("swimmer").with_levels(np.array([3500.0, 4500.0, 5500.0]))
    amplitudes = {"amplitude_3500": 0.0268, "amplitude_4500": 0.0440, "amplitude_5500": 0.0624}
    return model.with_values({**amplitudes, "slope": 0.264})


def box_run(duration: float = 1.0, voltage: float = 5500.0, frequency: float = 2.0) -> Run:
    """Alternating boxes of voltage [V] at a frequency [Hz], upper muscle first, filmed for a duration [s]."""
    switches = np.arange(0.0, duration, 0.5 / frequency)
    upper = np.arange(len(switches)) % 2 == 0
    voltages = voltage * np.stack([upper, ~upper], axis=1).astype(float)
    frames = np.arange(round(duration * FRAMES_PER_SECOND) + 1) / FRAMES_PER_SECOND
    return Run("5.5 kV, 2 Hz", frames, DriveSchedule(switches, voltages))


def swimmer_with_every_force() -> Model:
    """The swimmer in oil with all effects of its fluid that may stand side by side."""
    model = load_model("swimmer_in_oil").with_effects("form_drag", "viscous_drag")
    further = {"form_drag.coefficient": 0.05, "viscous_drag.across": 4.0, "viscous_drag.along": 2.0}
    return model.with_values(further)


def node_count(model: Model) -> int:
    """Nodes of a model's mesh."""
    return len(model_mesh(model).nodes)


def with_nodes(model: Model, wanted: int) -> Model:
    """The model with the mesh density whose number of nodes comes nearest to the wanted one."""
    densities = np.arange(0.3, 8.0, 0.05)
    models = [model.with_numerics(mesh_density=float(density)) for density in densities]
    return min(models, key=lambda candidate: abs(node_count(candidate) - wanted))


_FIRST_RUN = """
import time
import numpy as np
from hasel_sim.bench.cases import box_run, fitted_swimmer
from hasel_sim.simulate import simulate
start = time.process_time()
simulate(fitted_swimmer(), box_run(0.02), ["slope"])
print(time.process_time() - start)
"""


def processor_seconds(works: Sequence[Callable[[], object]], repeats: int) -> list[float]:
    """Median processor time [s] of a call of each, after one that is not counted.

    They take turns, so that a machine whose speed drifts is as fast for one as for another.
    """
    times = [[_seconds(work) for work in works] for _ in range(1 + repeats)]
    return np.median(times[1:], axis=0).tolist()


def _seconds(work: Callable[[], object]) -> float:
    start = time.process_time()
    work()
    return time.process_time() - start


def first_run_seconds() -> float:
    """Processor time [s] of the first simulation on a machine that has compiled nothing yet."""
    with tempfile.TemporaryDirectory() as cache:
        environment = {**os.environ, "NUMBA_CACHE_DIR": cache}
        output = subprocess.run(
            [sys.executable, "-c", _FIRST_RUN], env=environment, check=True, capture_output=True, text=True
        )
    return float(output.stdout)


def band_solutions(model: Model, times: int) -> Callable[[], None]:
    """Work: solve, so many times, a banded system of the model's unknowns and bandwidth, with pivoting (dgbsv)."""
    reach = model_mesh(model).reach
    unknowns, half_bandwidth = len(reach), int(reach.max())
    random = np.random.default_rng(0)
    band = random.standard_normal((3 * half_bandwidth + 1, unknowns))
    band[2 * half_bandwidth] += 100.0
    right_hand_side = random.standard_normal(unknowns)

    def work() -> None:
        for _ in range(times):
            lapack.dgbsv(half_bandwidth, half_bandwidth, band, right_hand_side)

    return work


KERNELS = {
    ("time_loop.py", "integrate"): "the compiled time loop",
    ("prepared_run.py", "__init__"): "mesh, matrices, drive (prepared once)",
    ("prepared_run.py", "start"): "the state it starts from",
    ("simulate.py", "_observed"): "what the markers see of it",
}
REST = "everything else"


def shares(model: Model) -> list[tuple[str, float]]:
    """What is done and its share of the time, largest first."""
    simulate(model, box_run(0.05))
    profile = cProfile.Profile()
    profile.runcall(simulate, model, box_run())
    rows = pstats.Stats(profile).stats  # type: ignore[attr-defined]
    total = sum(row[2] for row in rows.values())  # 2: time in the function itself, 3: with what it calls
    found = {
        label: sum(
            row[3] for (path, _, name), row in rows.items() if path.endswith(file) and name == function
        )
        for (file, function), label in KERNELS.items()
    }
    found[REST] = total - sum(found.values())
    return sorted(((label, seconds / total) for label, seconds in found.items()), key=lambda pair: -pair[1])


@dataclass(frozen=True)
class BarsReport:
    """Base of the dataclasses that hold what was measured."""

    def bars(self) -> list[MeasuredBar]:
        """The figures that have a bar."""
        raise NotImplementedError

    def values(self) -> dict[str, Any]:
        """Everything as plain values, for JSON."""
        return asdict(self) | {"bars": [asdict(bar) | {"met": bar.met} for bar in self.bars()]}


def table_of(title: str, headings: Sequence[str], rows: Iterable[Sequence[str]], words: int = 0) -> Table:
    """A table of numbers; words: how many of its first columns hold words."""
    columns = [Column(h, justify="left" if n < words else "right") for n, h in enumerate(headings)]
    table = Table(*columns, title=title)
    for row in rows:
        table.add_row(*row)
    return table


def bars_table(bars: list[MeasuredBar]) -> Table:
    """Measured values beside their bars."""
    rows = [
        (
            bar.what,
            f"{bar.measured:.2f}",
            f"{'≥' if bar.at_least else '≤'} {bar.limit:g}",
            "yes" if bar.met else "NO",
        )
        for bar in bars
    ]
    return table_of("Bars", ("what", "measured", "bar", "met"), rows, words=4)
