"""Cost of a second of motion: forward, with all sensitivities, and by the adjoint; by nodes and by parameters."""

import itertools
from dataclasses import dataclass

import numpy as np

from hasel_sim.adjoint import DifferentiableRun
from hasel_sim.bench.cases import (
    FRAMES_PER_SECOND,
    box_run,
    fitted_swimmer,
    node_count,
    swimmer_with_every_force,
    with_nodes,
)
from hasel_sim.bench.reference import band_solutions
from hasel_sim.bench.timing import processor_seconds
from hasel_sim.model import Model
from hasel_sim.simulate import simulate, simulate_many

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

    adjoint: the sweep back alone; band_solutions: LAPACK solving one linear system per time step (`bench.reference`).
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
