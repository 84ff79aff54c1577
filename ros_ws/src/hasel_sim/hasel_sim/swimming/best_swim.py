"""What swims best: waveform of two muscles, outline and other numbers of the body, by exact gradients of the swim."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import torch
from scipy.optimize import minimize

from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.goal import DifferentiableSwim, SwimOf
from hasel_sim.swimming.shape_limits import shape_limits
from hasel_sim.swimming.task import Task
from hasel_sim.swimming.tried import BestSwim, Tried
from hasel_sim.swimming.variables import Variables

_SETTLED_PERIODS = 2
_TOLERANCE = 1e-5
_HARDLY_ANOTHER = 1e-4
"""Two swimmers closer than this are one: half a volt, or a ten-thousandth of a period or a length."""
_PER_RADIAN = 10.0
"""What a constraint on an angle is scaled with, so that hundredths of a degree count."""


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
            constraints=[*swims.constraints(), *shape_limits(variables)],
            method="SLSQP",
            options={"maxiter": most, "ftol": _TOLERANCE},
        ).x
        swims(best)
    except _Settled:
        best = swims.asked[-1]
    tried = tuple(found.tried for found in swims.found.values())
    return BestSwim(tried[0], swims.found[np.array(best).tobytes()].tried, tried, task)
