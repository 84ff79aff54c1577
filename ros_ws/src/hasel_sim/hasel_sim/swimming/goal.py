"""Speed, heading and power of a free body as differentiable functions of PyTorch, in the sense of `free_swim`."""

from dataclasses import astuple, dataclass

import numpy as np
import torch

from hasel_sim.adjoint import DifferentiableRun
from hasel_sim.build import Builder, constant_parameter
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sim.model.model_parameters import constants
from hasel_sim.run import Run
from hasel_sim.swimming.free_swim import check_swimmer


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


@dataclass(frozen=True)
class _Fibres:
    """A muscle's: gradients along them [elements, points, 8], volumes per depth [elements, points], stiffness [Pa]."""

    along: np.ndarray
    volume: np.ndarray
    stiffness: np.ndarray


@dataclass(frozen=True)
class _Body:
    """What of a body enters its work beside its motion: depth [m], mass [kg] and its muscles' fibres."""

    depth: np.ndarray
    mass: np.ndarray
    fibres: tuple[_Fibres, ...]

    @staticmethod
    def of(model: Model) -> "_Body":
        builder, depth = Builder(model), model.described.body.depth_m or 0.0
        solid, fibres = builder.system().solid, []
        for number, muscle in enumerate(model.described.muscles):
            within = builder.mesh.muscle == number + 1
            stretch = solid.stretch[within, :, 0]
            along = solid.gradients[within, :, :, 0] / stretch[..., None]
            fibres.append(_Fibres(along, solid.areas[within] * stretch, np.array(muscle.fibre_stiffness_pa)))
        return _Body(np.array(depth), np.array(depth * _nodal_mass(builder).sum()), tuple(fibres))

    @property
    def arrays(self) -> list[np.ndarray]:
        """All its numbers, in one order."""
        return [self.depth, self.mass, *(array for each in self.fibres for array in astuple(each))]


def _nodal_mass(builder: Builder) -> np.ndarray:
    """Mass per depth that goes with each node [kg/m] [nodes]."""
    return builder.mass.product(np.ones((1, *builder.nodes.shape, 1)))[0, :, 0, 0]


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
        nodal = _nodal_mass(builder)
        self._share = torch.from_numpy(nodal / nodal.sum())
        self._rest = torch.from_numpy(builder.nodes - nodal @ builder.nodes / nodal.sum())
        self._muscles = [
            torch.from_numpy(builder.mesh.elements[builder.mesh.muscle == number + 1])
            for number in range(len(model.description.muscles))
        ]
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
        sine = torch.einsum("n,tn->t", self._share, self._cross(arms))
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
        """The numbers of `_Body` with their derivatives by those of the values that are constants of the file."""
        run = self.differentiable
        model = run.at(values)
        found = [torch.from_numpy(array) for array in _Body.of(model).arrays]
        known = constants(model.description)
        for place, name in enumerate(run.parameters):
            if name not in known or not values.requires_grad:
                continue
            more, less, width = constant_parameter(model, name).around(model.values[name])
            ends = [_Body.of(model.with_values({name: value})).arrays for value in (more, less)]
            step = values[place] - values[place].detach()
            found = [
                one + step * torch.as_tensor((above - below) / width)
                for one, above, below in zip(found, *ends, strict=True)
            ]
        return found

    def _cross(self, arms: torch.Tensor) -> torch.Tensor:
        return self._rest[:, 0] * arms[..., 1] - self._rest[:, 1] * arms[..., 0]

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
    rows = np.zeros((periods, len(time)))
    for column in range(len(time)):
        unit = np.zeros(len(time))
        unit[column] = 1.0
        integral = np.concatenate([[0.0], np.cumsum(0.5 * (unit[1:] + unit[:-1]) * np.diff(time))])
        rows[:, column] = frequency * np.diff(np.interp(bounds, time, integral))
    return rows
