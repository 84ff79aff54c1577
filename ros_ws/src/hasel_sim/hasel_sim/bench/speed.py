# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Cost of a second of motion: forward, with all sensitivities, by the adjoint; by nodes and by parameters; of swims."""

import itertools
import os
import time
from dataclasses import dataclass

import numpy as np
from hasel_common.measured_bar import MeasuredBar
from rich.console import Console
from rich.table import Table

from hasel_sim.adjoint import DifferentiableRun
from hasel_sim.bench.cases import (
    FRAMES_PER_SECOND,
    BarsReport,
    band_solutions,
    bars_table,
    box_run,
    fitted_swimmer,
    node_count,
    processor_seconds,
    swimmer_with_every_force,
    table_of,
    with_nodes,
)
from hasel_sim.model import Model, load_model
from hasel_sim.parallel import executor
from hasel_sim.simulate import simulate, simulate_many
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.sweep import sweep

REPEATS = 5
MANY_PARAMETERS = (
    "soft_modulus",
    "spine_modulus",
    "material_damping",
    "pre_bend",
    "quadratic_drag",
    "linear_drag",
)


@dataclass(frozen=True)
class Speed:
    """Processor seconds per second of motion on a mesh.

    adjoint: the sweep back alone; band_solutions: LAPACK solving one linear system per time step (`band_solutions`).
    """

    nodes: int
    parameters: int
    forward: float
    sensitivities: float
    adjoint: float
    band_solutions: float

    @property
    def real_time_factor(self) -> float:
        """Seconds of motion simulated per second."""
        return 1 / self.forward

    @property
    def solutions_per_step(self) -> float:
        """Cost of a time step in solutions of its linear system by LAPACK; the machine's speed all but cancels."""
        return self.forward / self.band_solutions

    def __str__(self) -> str:
        sensitivities, adjoint = self.sensitivities / self.forward, self.adjoint / self.forward
        return (
            f"{self.nodes} nodes: {self.milliseconds(self.forward):.2f} ms a frame, "
            f"{self.real_time_factor:.1f} x real time; with all sensitivities {sensitivities:.2f} x, "
            f"adjoint sweep {adjoint:.2f} x; a step costs {self.solutions_per_step:.1f} LAPACK solutions"
        )

    @staticmethod
    def milliseconds(seconds: float) -> float:
        """Milliseconds per frame at 120 frames a second."""
        return 1e3 * seconds / FRAMES_PER_SECOND


def measure_speed(model: Model) -> Speed:
    """Speed with one model at 5.5 kV, 2 Hz, differentiated by all its parameters."""
    run, names = box_run(), list(model.parameters)
    differentiable = DifferentiableRun(model, run, names)

    def there_and_back() -> None:
        values = differentiable.values().requires_grad_()
        differentiable.angle(values=values).square().sum().backward()

    steps = round(model.description.numerics.steps_per_second * run.time[-1])
    forward, both, sensitivities, reference = processor_seconds(
        [
            lambda: simulate(model, run),
            there_and_back,
            lambda: simulate(model, run, names),
            band_solutions(model, steps),
        ],
        REPEATS,
    )
    return Speed(node_count(model), len(names), forward, sensitivities, both - forward, reference)


@dataclass(frozen=True)
class SideBySide:
    """Processor time [s] of several runs of the default swimmer, one after the other and side by side in lanes."""

    runs: int
    after_the_other: float
    side_by_side: float
    sensitivities_after_the_other: float
    sensitivities_side_by_side: float

    @property
    def forward_ratio(self) -> float:
        """How much less the runs cost side by side."""
        return self.after_the_other / self.side_by_side

    @property
    def sensitivities_ratio(self) -> float:
        """The same with the derivatives by all parameters."""
        return self.sensitivities_after_the_other / self.sensitivities_side_by_side


def measure_side_by_side(model: Model) -> SideBySide:
    """As many runs as there are lanes, at several voltages and frequencies."""
    drives = itertools.product((5500.0, 4500.0), (2.0, 3.5))
    cases = [(model, box_run(0.5, voltage, frequency)) for voltage, frequency in drives]
    names = list(model.parameters)
    works = [
        work
        for asked in ([], names)
        for work in (
            lambda asked=asked: [simulate(model, run, asked) for _, run in cases],
            lambda asked=asked: simulate_many(cases, asked),
        )
    ]
    return SideBySide(len(cases), *processor_seconds(works, REPEATS))


def by_nodes(wanted: tuple[int, ...]) -> tuple[list[Speed], float]:
    """Speeds on meshes of about so many nodes, and the slope of log cost against log nodes."""
    speeds = [measure_speed(with_nodes(fitted_swimmer(), nodes)) for nodes in wanted]
    nodes, cost = np.log([[s.nodes, s.forward] for s in speeds]).T
    return speeds, float(np.polyfit(nodes, cost, 1)[0])


def by_parameters() -> list[tuple[int, float]]:
    """Number of parameters and cost with all their sensitivities over the forward cost, on one model with effects."""
    model, run = fitted_swimmer().with_effects(*MANY_PARAMETERS), box_run()
    names = list(model.parameters)
    counts = sorted({0, 1, 2, 4, len(names)})
    works = [lambda n=n: simulate(model, run, names[len(names) - n :]) for n in counts]
    costs = processor_seconds(works, 3)
    return [(n, cost / costs[0]) for n, cost in zip(counts, costs, strict=True)]


def free_swim_factor(duration: float = 10.0) -> float:
    """Real-time factor of a free swim [s] at 5.5 kV, 2 Hz with every force of the fluid, default mesh, one core."""
    model = swimmer_with_every_force()
    run = box_run(duration)
    (seconds,) = processor_seconds([lambda: simulate(model, run)], 1)
    return duration / seconds


@dataclass(frozen=True)
class SpeedReport(BarsReport):
    """All speeds; slope: of log cost against log nodes; parameters: (number, cost over forward).

    free_swim: real-time factor of a free swim of 10 s with every force of the fluid.
    """

    first_run: float
    sizes: list[Speed]
    default: Speed
    large: Speed
    slope: float
    parameters: list[tuple[int, float]]
    lanes: SideBySide
    profile: list[tuple[str, float]]
    free_swim: float

    def bars(self) -> list[MeasuredBar]:
        """The figures that have a bar."""
        named = (("default mesh", self.default), (f"{self.large.nodes} nodes", self.large))
        swim = "real-time factor, free swim of 10 s with every force of the fluid"
        lanes = f"{self.lanes.runs} runs side by side / one after the other"
        return [
            *(
                MeasuredBar(f"real-time factor, {name}", speed.real_time_factor, bar, at_least=True)
                for (name, speed), bar in zip(named, (5, 2), strict=True)
            ),
            MeasuredBar(swim, self.free_swim, 5, at_least=True),
            *(
                MeasuredBar(f"all sensitivities / forward, {name}", s.sensitivities / s.forward, 2)
                for name, s in named
            ),
            *(MeasuredBar(f"adjoint sweep / forward, {name}", s.adjoint / s.forward, 2) for name, s in named),
            MeasuredBar(lanes, self.lanes.forward_ratio, 4, at_least=True),
            MeasuredBar("first run, compiling (s)", self.first_run, 30),
        ]

    def print(self, console: Console) -> None:
        """Print the tables."""
        headings = ("nodes", "ms/frame", "x real time", "all sensitivities", "adjoint sweep", "LAPACK/step")
        sizes = [
            (
                str(speed.nodes),
                f"{speed.milliseconds(speed.forward):.2f}",
                f"{speed.real_time_factor:.1f}",
                *(f"{part / speed.forward:.2f} x" for part in (speed.sensitivities, speed.adjoint)),
                f"{speed.solutions_per_step:.1f}",
            )
            for speed in self.sizes
        ]
        cost = f"Processor time on one core, 240 steps/s; cost grows as nodes^{self.slope:.2f}"
        counts = [str(count) for count, _ in self.parameters]
        ratios = [f"{ratio:.2f} x" for _, ratio in self.parameters]
        lanes = self.lanes
        forward = lanes.after_the_other, lanes.side_by_side, lanes.forward_ratio
        with_slopes = (
            lanes.sensitivities_after_the_other,
            lanes.sensitivities_side_by_side,
            lanes.sensitivities_ratio,
        )
        beside = [
            (name, f"{1e3 * alone:.0f} ms", f"{1e3 * together:.0f} ms", f"{ratio:.2f} x")
            for name, (alone, together, ratio) in (
                ("forward", forward),
                ("with all sensitivities", with_slopes),
            )
        ]
        profile = Table("where the time goes", "share", title="Default mesh, forward")
        for label, share in self.profile:
            profile.add_row(label, f"{100 * share:.0f} %")
        console.print(
            table_of(cost, headings, sizes),
            table_of(
                "Forward cost with sensitivities, by number of parameters (six effects)", counts, [ratios]
            ),
            table_of(
                f"{lanes.runs} runs of 0.5 s, default mesh, processor time",
                ("", "one after the other", "side by side", "ratio"),
                beside,
                words=1,
            ),
            profile,
            bars_table(self.bars()),
        )


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
