# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What swims best: waveform of two muscles, outline and other numbers of the body, by exact gradients of the swim.

Speed, heading and power are those of `free_swim`, as differentiable functions of PyTorch.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from scipy.optimize import minimize

from hasel_sim.adjoint import DifferentiableRun
from hasel_sim.build import Builder, constant_parameter
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sim.model.model_parameters import constants
from hasel_sim.run import Run
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.free_swim import check_swimmer, muscle_fibres, nodal_masses
from hasel_sim.swimming.search import BestSwim, Task, Tried, Variables, shape_limits

_SETTLED_PERIODS = 2
_TOLERANCE = 1e-5
_HARDLY_ANOTHER = 1e-4
"""Two swimmers closer than this are one: half a volt, or a ten-thousandth of a period or a length."""
_PER_RADIAN = 10.0
"""What a constraint on an angle is scaled with, so that hundredths of a degree count."""


@dataclass(frozen=True)
class SwimOf:
    """What a swim came to, each a scalar.

    speed: settled, forwards [m/s]; turning: to the left [rad/s]; heading: mean over the last period, to the left of
    that at rest [rad]; power: mean, of the muscles [W]; mass: of the body [kg].
    """

    speed: torch.Tensor
    turning: torch.Tensor
    heading: torch.Tensor
    power: torch.Tensor
    mass: torch.Tensor

    @property
    def cost_of_transport(self) -> torch.Tensor:
        """Work of the muscles per mass and distance [J/(kg m)]."""
        return self.power / (self.mass * self.speed)


def _body_numbers(model: Model) -> list[np.ndarray]:
    """What of a body enters its work beside its motion: depth [m], mass [kg], then of every muscle what
    `muscle_fibres` says.
    """
    builder, depth = Builder(model), model.described.body.depth_m or 0.0
    numbers = [depth, depth * nodal_masses(builder).sum()]
    numbers += [number for _, *own in muscle_fibres(builder) for number in own]
    return [np.asarray(number) for number in numbers]


class DifferentiableSwim:
    """A swim of one run as a function of its contraction and of named parameters, those of the shape among them.

    frequency [Hz] and periods: of the drive, and over how many of them at the end is measured. The place of the body is
    a mean over its nodes with the masses of the model as it stands, which swims as fast as any other mean.
    """

    def __init__(
        self, model: Model, run: Run, frequency: float, periods: int, parameters: tuple[str, ...] = ()
    ) -> None:
        check_swimmer(model)
        self.model, self.frequency, self.periods = model, frequency, periods
        self.differentiable = DifferentiableRun(model, run, parameters)
        builder = Builder(model)
        nodal = nodal_masses(builder)
        self._share = torch.from_numpy(nodal / nodal.sum())
        self._rest = torch.from_numpy(builder.nodes - nodal @ builder.nodes / nodal.sum())
        self._muscles = [torch.from_numpy(nodes) for nodes, *_ in muscle_fibres(builder)]
        time = self.differentiable.boundaries
        if (time[-1] - time[0]) * frequency < periods + 1:
            raise SimulationError(
                f"the run holds {(time[-1] - time[0]) * frequency:.3g} periods; expected more than {periods}, over "
                "which the swim is measured: swim longer"
            )
        self._means = torch.from_numpy(period_means(time, frequency, periods))

    def __call__(self, contraction: torch.Tensor, values: torch.Tensor | None = None) -> SwimOf:
        """How the body swims with a contraction [steps, muscles] at the differentiable run's balance times."""
        values = self.differentiable.values() if values is None else values
        shapes = self.differentiable.shapes(contraction, values)
        depth, mass, *fibres = self._body(values)
        place = torch.einsum("n,tnd->td", self._share, shapes)
        arms = shapes - place[:, None]
        cross = self._rest[:, 0] * arms[..., 1] - self._rest[:, 1] * arms[..., 0]
        sine = torch.einsum("n,tn->t", self._share, cross)
        cosine = torch.einsum("n,nd,tnd->t", self._share, self._rest, arms)
        angle = torch.atan2(sine, cosine)
        # whole turns are constants, so that the angle goes on where atan2 jumps
        turned = angle + torch.from_numpy(np.unwrap(angle.detach().numpy())) - angle.detach()
        x, y, heading = self._means @ place[:, 0], self._means @ place[:, 1], self._means @ turned
        ahead = 0.5 * (heading[1:] + heading[:-1])
        gained = -(torch.diff(x) * torch.cos(ahead) + torch.diff(y) * torch.sin(ahead))
        rate = self.frequency / (self.periods - 1)
        power = depth * self._work(shapes, contraction, fibres)
        return SwimOf(gained.sum() * rate, (heading[-1] - heading[0]) * rate, heading[-1], power, mass)

    def _body(self, values: torch.Tensor) -> list[torch.Tensor]:
        """The numbers of the body with their derivatives by those of the values that are constants of the file."""
        run = self.differentiable
        model = run.at(values)
        found = [torch.from_numpy(array) for array in _body_numbers(model)]
        known = constants(model.description)
        for place, name in enumerate(run.parameters):
            if name not in known or not values.requires_grad:
                continue
            more, less, width = constant_parameter(model, name).around(model.values[name])
            ends = [_body_numbers(model.with_values({name: value})) for value in (more, less)]
            step = values[place] - values[place].detach()
            found = [
                one + step * torch.as_tensor((above - below) / width)
                for one, above, below in zip(found, *ends, strict=True)
            ]
        return found

    def _work(
        self, shapes: torch.Tensor, contraction: torch.Tensor, fibres: list[torch.Tensor]
    ) -> torch.Tensor:
        """Mean power of the muscles per depth over the last periods [W/m]."""
        boundaries = self.differentiable.boundaries
        window = self.periods / self.frequency
        late = torch.from_numpy(boundaries[1:-1] > boundaries[-1] - window)
        total = torch.zeros((), dtype=torch.float64)
        for number, nodes in enumerate(self._muscles):
            along, volume, stiffness = fibres[3 * number : 3 * number + 3]
            fibre = torch.einsum("epk,tekd->tepd", along, shapes[1:-1][late][:, nodes])
            own = contraction[:, number]
            short = 1.0 - 0.5 * (own[1:] + own[:-1])[late]
            excess = torch.linalg.vector_norm(fibre, dim=-1) - short[:, None, None]
            pull = stiffness * (excess * volume).sum(dim=(1, 2))
            total = total + (pull * torch.diff(own)[late]).sum()
        return total / window


def period_means(time: np.ndarray, frequency: float, periods: int) -> np.ndarray:
    """Rows [periods, n] that take a series at times [s] [n] to its means over the last periods (trapezoid rule)."""
    bounds = time[-1] - np.arange(periods, -1, -1) / frequency
    units = np.eye(len(time))
    steps = 0.5 * (units[1:] + units[:-1]) * np.diff(time)[:, None]
    integrals = np.concatenate([np.zeros((1, len(time))), np.cumsum(steps, axis=0)])
    return frequency * np.diff([np.interp(bounds, time, integral) for integral in integrals.T], axis=1).T


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

    def constraints(self) -> list[dict[str, Any]]:
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
