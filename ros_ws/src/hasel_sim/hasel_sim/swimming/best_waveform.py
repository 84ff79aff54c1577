"""The waveform that swims best: voltages, duty and phase of two muscles, by exact gradients through the swim."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import torch
from scipy.optimize import minimize

from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.goal import DifferentiableSwim

RANGES = {"first": (0.4, 1.0), "second": (0.4, 1.0), "duty": (0.2, 1.0), "phase": (0.25, 0.75)}
"""What may be varied and how far; voltages as shares of the largest."""
GOALS = ("speed", "cost")
_SETTLED_PERIODS = 2
_TOLERANCE = 1e-5
_HARDLY_ANOTHER = 1e-4
"""Two waveforms closer than this are one: half a volt, or a ten-thousandth of a period."""


@dataclass(frozen=True)
class Task:
    """What is sought: the fastest swim, or the cheapest per distance; turning at a rate [rad/s], or freely for None.

    vary: names among RANGES; largest: voltage [V]; duration: of the swims that are tried [s].
    """

    goal: str = "speed"
    turning: float | None = None
    vary: tuple[str, ...] = ("first", "second")
    largest: float = 5500.0
    duration: float = 4.0

    def __post_init__(self) -> None:
        if self.goal not in GOALS:
            raise SimulationError(f"'{self.goal}' is no goal; expected one of {', '.join(GOALS)}")
        unknown = [name for name in self.vary if name not in RANGES]
        if unknown or not self.vary:
            raise SimulationError(
                f"'{', '.join(unknown)}' cannot be varied; expected some of {', '.join(RANGES)}: name these"
            )


@dataclass(frozen=True)
class Tried:
    """A waveform with what it came to: speed [m/s], turning [rad/s], power [W] and the mass it moved [kg]."""

    drive: Boxes
    speed: float
    turning: float
    power: float
    mass: float

    @property
    def cost_of_transport(self) -> float:
        """Work per mass and distance [J/(kg m)]."""
        return self.power / (self.mass * self.speed) if self.speed > 0 else np.inf

    def __str__(self) -> str:
        return (
            f"{self.drive}, duty {self.drive.duty:.3f}, phase {self.drive.phase:.3f}: {1e3 * self.speed:.2f} mm/s, "
            f"{np.degrees(self.turning):+.3f}°/s, {self.cost_of_transport:.3g} J/(kg m)"
        )


@dataclass(frozen=True)
class BestWaveform:
    """The start and the best, and everything that was tried on the way."""

    start: Tried
    best: Tried
    tried: tuple[Tried, ...] = field(repr=False)

    def __str__(self) -> str:
        return f"from {self.start}\nto   {self.best}\nafter {len(self.tried)} swims with gradients."


class _Settled(Exception):  # noqa: N818  an end, not a fault
    """The search has come back to where it was."""


class _Swims:
    """Swims and their gradients by the numbers that are varied; each point is swum once."""

    def __init__(self, model: Model, start: Boxes, task: Task) -> None:
        self.model, self.start, self.task = model, start, task
        run = start.run(model, task.duration)
        self.swim = DifferentiableSwim(model, run, start.frequency, _SETTLED_PERIODS)
        self.tried: list[Tried] = []
        self._known: dict[bytes, tuple[np.ndarray, np.ndarray]] = {}

    def drive(self, numbers: np.ndarray) -> Boxes:
        """The boxes that the numbers stand for."""
        values = dict(zip(self.task.vary, np.asarray(numbers, dtype=float).tolist(), strict=True))
        scales = dict.fromkeys(("first", "second"), self.task.largest)
        changed: dict[str, float] = {name: value * scales.get(name, 1.0) for name, value in values.items()}
        return replace(self.start, **changed)

    def schedule(self, numbers: np.ndarray) -> DriveSchedule:
        """Their voltages."""
        return self.drive(numbers).schedule(self.task.duration, self.model.channels)

    def __call__(self, numbers: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Speed, turning and power [3] and their derivatives by the numbers [3, n]."""
        key = np.asarray(numbers, dtype=float).tobytes()
        if key not in self._known:
            waveform = torch.tensor(numbers, dtype=torch.float64, requires_grad=True)
            contraction = self.swim.differentiable.contraction_from(waveform, self.schedule)
            of = self.swim(contraction)
            found = (of.speed, of.turning, of.power)
            slopes = [torch.autograd.grad(one, waveform, retain_graph=True)[0].numpy() for one in found]
            values = np.array([one.item() for one in found])
            self._known[key] = values, np.stack(slopes)
            speed, turning, power = values.tolist()
            self.tried.append(Tried(self.drive(numbers), speed, turning, power, self.swim.mass))
        return self._known[key]


def best_waveform(
    model: Model, start: Boxes, task: Task, most: int = 20, told: Callable[[Tried], None] = lambda tried: None
) -> BestWaveform:
    """Improve a start by sequential quadratic programming, in at most so many iterations.

    told: called with every swim. Raises SimulationError for a body that cannot swim, or a start out of range.
    """
    swims = _Swims(model, start, task)
    numbers = np.array([getattr(start, name) for name in task.vary], dtype=float)
    for place, name in enumerate(task.vary):
        if name in ("first", "second"):
            numbers[place] /= task.largest
    bounds = [RANGES[name] for name in task.vary]
    for name, number, (low, high) in zip(task.vary, numbers, bounds, strict=True):
        if not low - 1e-9 <= number <= high + 1e-9:
            raise SimulationError(
                f"{name} starts at {number:.3g}; expected {low:g} to {high:g} (voltages as shares of the largest, "
                f"{task.largest:g} V): start from another value or raise the largest voltage"
            )

    asked: list[np.ndarray] = []

    def ask(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        before = len(swims.tried)
        found = swims(x)
        if len(swims.tried) > before:
            told(swims.tried[-1])
            again = any(np.abs(x - other).max() < _HARDLY_ANOTHER for other in asked)
            asked.append(np.array(x))
            if again:
                raise _Settled
        return found

    first, _ = ask(numbers)
    scale = abs(first[0]) + 1e-9

    def loss(x: np.ndarray) -> tuple[float, np.ndarray]:
        (speed, _, power), (by_speed, _, by_power) = ask(x)
        if task.goal == "speed":
            return -speed / scale, -by_speed / scale
        cost, start_cost = power / speed, first[2] / first[0]
        return cost / start_cost, (by_power / speed - cost / speed * by_speed) / start_cost

    wanted: Sequence[dict] = ()
    if task.turning is not None:
        off = {
            "type": "eq",
            "fun": lambda x: 10.0 * (ask(x)[0][1] - task.turning),
            "jac": lambda x: 10.0 * ask(x)[1][1],
        }
        wanted = (off,)
    options = {"maxiter": most, "ftol": _TOLERANCE}
    best = numbers
    try:
        best = minimize(
            loss, numbers, jac=True, bounds=bounds, constraints=wanted, method="SLSQP", options=options
        ).x
        ask(best)
    except _Settled:
        best = asked[-1]
    by_drive = {tried.drive: tried for tried in swims.tried}
    return BestWaveform(swims.tried[0], by_drive[swims.drive(best)], tuple(swims.tried))


def waveform_rows(drive: Boxes, duration: float, channels: tuple[str, ...]) -> str:
    """A drive as CSV, each row holding until the next, that ends with both channels at rest at the duration [s]."""
    schedule = drive.schedule(duration, channels)
    lines = ["time_s," + ",".join(f"voltage_{name}_v" for name in channels)]
    lines += [
        ",".join(f"{number:.6f}".rstrip("0").rstrip(".") for number in (time, *row))
        for time, row in zip(schedule.time, schedule.signal, strict=True)
        if time < duration
    ]
    return "\n".join([*lines, ",".join([f"{duration:g}", *["0"] * len(channels)])]) + "\n"
