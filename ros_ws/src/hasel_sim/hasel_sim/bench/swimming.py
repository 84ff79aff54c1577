"""How long a free swim takes, and the sweep of swims that the README draws."""

import os
import time
from dataclasses import dataclass

import numpy as np
from hasel_common.measured_bar import MeasuredBar
from rich.console import Console

from hasel_sim.bench.cases import BarsReport, bars_table
from hasel_sim.bench.speed import free_swim_factor
from hasel_sim.model import load_model
from hasel_sim.parallel import executor
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.sweep import sweep

VOLTAGES = (3500.0, 4500.0, 5500.0)
FREQUENCIES = tuple(np.arange(1.0, 10.01, 0.5).tolist())
DURATION_S, JOBS = 10.0, 2


@dataclass(frozen=True)
class SwimmingReport(BarsReport):
    """free_swim: real-time factor of a swim of 10 s with every force of the fluid, by processor time of one core;
    sweep: time of `swims` swims by the clock on the wall, in `JOBS` processes [s]; load: processes that wanted a core
    before it began.
    """

    free_swim: float
    swims: int
    sweep: float
    load: float

    def bars(self) -> list[MeasuredBar]:
        """The figures that have a bar."""
        return [
            MeasuredBar(
                f"real-time factor, free swim of {DURATION_S:g} s with every force of the fluid",
                self.free_swim,
                5,
                True,
            ),
            MeasuredBar(
                f"sweep of {self.swims} swims of {DURATION_S:g} s, {JOBS} processes (s)", self.sweep, 300
            ),
        ]

    def print(self, console: Console) -> None:
        """Print the bars, and how busy the machine was with other work."""
        console.print(bars_table(self.bars()))
        console.print(
            f"{self.load:.1f} processes were at work on {os.cpu_count()} cores before the sweep began.",
            soft_wrap=True,
        )


def measure_swimming(
    duration: float = DURATION_S,
    voltages: tuple[float, ...] = VOLTAGES,
    frequencies: tuple[float, ...] = FREQUENCIES,
) -> SwimmingReport:
    """A free swim, and the swims of the model `swimmer_in_oil` at every voltage [V] and frequency [Hz]."""
    factor = free_swim_factor(duration)
    model, drives = load_model("swimmer_in_oil"), [Boxes(v, v, f) for v in voltages for f in frequencies]
    load = os.getloadavg()[0]
    with executor(JOBS) as pool:
        start = time.perf_counter()
        swam = sweep(pool, model, drives, duration)
    return SwimmingReport(factor, len(swam), time.perf_counter() - start, load)
