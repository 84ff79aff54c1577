"""What swims best: waveform of two muscles, outline and other numbers of the body, by exact gradients of the swim."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
import torch
from scipy.optimize import minimize

from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.goal import DifferentiableSwim, SwimOf
from hasel_sim.swimming.variables import Range, Variables

GOALS = ("speed", "cost")
_SETTLED_PERIODS = 2
_TOLERANCE = 1e-5
_HARDLY_ANOTHER = 1e-4
"""Two swimmers closer than this are one: half a volt, or a ten-thousandth of a period or a length."""
_PER_RADIAN = 10.0
"""What a constraint on an angle is scaled with, so that hundredths of a degree count."""

_REACHED = np.radians(0.1)
"""How far [rad, rad/s] a turning or heading may be from what is wanted."""


@dataclass(frozen=True)
class Task:
    """What is sought: the fastest swim, or the one with the least cost of transport.

    turning: at a rate [rad/s]; heading: the body points there at the end, to the left of its start [rad]; either as it
    comes for None. vary, ranges: as of `Variables`; largest: voltage [V]; duration: of the swims that are tried [s].
    """

    goal: str = "speed"
    turning: float | None = None
    vary: tuple[str, ...] = ("first", "second")
    largest: float = 5500.0
    duration: float = 4.0
    heading: float | None = None
    ranges: Mapping[str, Range] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.goal not in GOALS:
            raise SimulationError(f"'{self.goal}' is no goal; expected one of {', '.join(GOALS)}")
        if self.turning is not None and self.heading is not None:
            raise SimulationError(
                "both turning and heading are given; expected one of them, since the one sets the other: leave one out"
            )


@dataclass(frozen=True)
class Tried:
    """A swimmer with what it came to.

    speed [m/s], turning [rad/s], heading at the end [rad], power [W] and the mass it moved [kg]; body: what of it was
    varied, in words; values: of the parameters that were.
    """

    drive: Boxes
    speed: float
    turning: float
    power: float
    mass: float
    heading: float = 0.0
    body: str = ""
    values: dict[str, float] = field(default_factory=dict, compare=False)

    @property
    def cost_of_transport(self) -> float:
        """Work per mass and distance [J/(kg m)]."""
        return self.power / (self.mass * self.speed) if self.speed > 0 else np.inf

    def __str__(self) -> str:
        body = f", {self.body}" if self.body else ""
        return (
            f"{self.drive}, duty {self.drive.duty:.3f}, phase {self.drive.phase:.3f}{body}: "
            f"{1e3 * self.speed:.2f} mm/s, {np.degrees(self.turning):+.3f}°/s, heading "
            f"{np.degrees(self.heading):+.2f}°, {self.cost_of_transport:.3g} J/(kg m)"
        )


@dataclass(frozen=True)
class BestSwim:
    """The start and the best, and everything that was tried on the way."""

    start: Tried
    best: Tried
    tried: tuple[Tried, ...] = field(repr=False)
    task: Task = Task()

    @property
    def missed(self) -> str:
        """A sentence about a turning or heading that was asked for and is not reached; empty where all is."""
        for name, unit in (("turning", "°/s"), ("heading", "°")):
            wanted, reached = getattr(self.task, name), getattr(self.best, name)
            if wanted is not None and abs(reached - wanted) > _REACHED:
                return (
                    f"The {name} of {np.degrees(wanted):g}{unit} is not reached, only {np.degrees(reached):.3g}{unit}: "
                    "let more vary, in wider ranges or for longer."
                )
        return ""

    def __str__(self) -> str:
        told = f"from {self.start}\nto   {self.best}\nafter {len(self.tried)} swims with gradients."
        return f"{told} {self.missed}".rstrip()

    def improved(self, model: Model) -> Model:
        """A model with the body that was found, as a file of its own would describe it."""
        changed = model.with_freed(*self.best.values).with_values(self.best.values)
        return changed.with_constants_settled(
            *(name for name in self.best.values if name not in model.parameters)
        )


class _Settled(Exception):  # noqa: N818  an end, not a fault
    """The search has come back to where it was."""


@dataclass(frozen=True)
class _Found:
    """What a swim came to and its derivatives by x: what is to be least, turning [rad/s] and heading [rad]."""

    loss: float
    turning: float
    heading: float
    slopes: dict[str, np.ndarray]
    tried: Tried


class _Swims:
    """Swims and their gradients by the numbers that are varied; each point is swum once."""

    def __init__(self, variables: Variables, task: Task, told: Callable[[Tried], None]) -> None:
        self.variables, self.task, self._told = variables, task, told
        self.model = variables.freed
        run = variables.boxes.run(self.model, task.duration)
        frequency = variables.boxes.frequency
        self.swim = DifferentiableSwim(self.model, run, frequency, _SETTLED_PERIODS, variables.names)
        self.found: dict[bytes, _Found] = {}
        self.asked: list[np.ndarray] = []

    def _contraction(self, numbers: torch.Tensor) -> torch.Tensor:
        """That of the boxes of x."""
        places = self.variables.of_waveform
        if not places:
            return self.swim.differentiable.contraction().detach()
        whole = numbers.detach().numpy()

        def schedule(waveform: np.ndarray) -> DriveSchedule:
            x = whole.copy()
            x[places] = waveform
            return self.variables.drive(x).schedule(self.task.duration, self.model.channels)

        return self.swim.differentiable.contraction_from(numbers[places], schedule)

    def __call__(self, x: np.ndarray) -> _Found:
        """The swim of x. Raises _Settled where it hardly differs from another before it."""
        x = np.array(x, dtype=float)
        if x.tobytes() in self.found:
            return self.found[x.tobytes()]
        numbers = torch.tensor(x, requires_grad=True)
        of = self.swim(self._contraction(numbers), torch.from_numpy(self.variables.matrix) @ numbers)
        parts = {"loss": self._loss(of), "turning": of.turning, "heading": of.heading}
        slopes = {
            name: torch.autograd.grad(part, numbers, retain_graph=True)[0].numpy()
            for name, part in parts.items()
        }
        tried = Tried(
            drive=self.variables.drive(x),
            speed=of.speed.item(),
            turning=of.turning.item(),
            power=of.power.item(),
            mass=of.mass.item(),
            heading=of.heading.item(),
            body=self.variables.text(x),
            values=self.variables.values(x),
        )
        found = _Found(parts["loss"].item(), tried.turning, tried.heading, slopes, tried)
        self.found[x.tobytes()] = found
        again = any(np.abs(x - other).max() < _HARDLY_ANOTHER for other in self.asked)
        self.asked.append(x)
        self._told(tried)
        if again:
            raise _Settled
        return found

    def _loss(self, of: SwimOf) -> torch.Tensor:
        return -of.speed if self.task.goal == "speed" else of.cost_of_transport

    def constraints(self) -> list[dict]:
        """What is asked of turning and heading."""
        out = []
        for name in ("turning", "heading"):
            wanted = getattr(self.task, name)
            if wanted is not None:
                out.append(
                    {
                        "type": "eq",
                        "fun": lambda x, n=name, w=wanted: _PER_RADIAN * (getattr(self(x), n) - w),
                        "jac": lambda x, n=name: _PER_RADIAN * self(x).slopes[n],
                    }
                )
        return out


def best_swim(
    model: Model, start: Boxes, task: Task, most: int = 20, told: Callable[[Tried], None] = lambda tried: None
) -> BestSwim:
    """Improve a start by sequential quadratic programming, in at most so many iterations.

    told: called with every swim. Raises SimulationError for a body that cannot swim, or a start out of range.
    """
    variables = Variables(model, start, task.vary, task.largest, task.ranges)
    swims = _Swims(variables, task, told)
    first = swims(variables.start)
    if task.goal == "cost" and first.tried.speed <= 0:
        raise SimulationError(
            f"the start swims at {1e3 * first.tried.speed:.3g} mm/s; expected it to swim forwards, so that its work "
            "per distance can fall: start from another frequency or voltage"
        )
    scale = abs(first.loss) + 1e-12

    def loss(x: np.ndarray) -> tuple[float, np.ndarray]:
        found = swims(x)
        return found.loss / scale, found.slopes["loss"] / scale

    best = variables.start
    try:
        best = minimize(
            loss,
            variables.start,
            jac=True,
            bounds=variables.bounds,
            constraints=[*swims.constraints(), *variables.constraints],
            method="SLSQP",
            options={"maxiter": most, "ftol": _TOLERANCE},
        ).x
        swims(best)
    except _Settled:
        best = swims.asked[-1]
    tried = tuple(found.tried for found in swims.found.values())
    return BestSwim(tried[0], swims.found[np.array(best).tobytes()].tried, tried, task)
