# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A run as differentiable functions of PyTorch: waveform -> contraction -> angle."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import torch

from hasel_sim.adjoint.gradient import Gradient, Trajectory, follow, gradient, gradient_of_shapes
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sim.model.model_parameters import outline_names
from hasel_sim.prepared_run import PreparedRun
from hasel_sim.run import Run

_Schedules = Callable[[np.ndarray], DriveSchedule]
"""From a waveform's numbers to the drive."""


class DifferentiableRun:
    """sin theta of one run as a function of its activation series, of named parameters and of the outline.

    All tensors are double precision on the CPU. `values` are those of `parameters`, in that order; `outline` are the
    body's outline coefficients. What is left out stays as the model says.
    """

    def __init__(self, model: Model, run: Run, parameters: Sequence[str] = ()) -> None:
        self.model, self.run, self.parameters = model, run, tuple(parameters)
        prepared = PreparedRun(model, run, self.parameters)
        self.balance_times = prepared.plan.balance_times
        """Instants [s] at which the contraction is given, [steps]."""
        self.boundaries = prepared.plan.boundaries
        """Instants [s] at which the shapes are, [steps + 1]."""

    def values(self) -> torch.Tensor:
        """The model's own values of the parameters."""
        return torch.tensor([self.model.values[name] for name in self.parameters], dtype=torch.float64)

    def outline(self) -> torch.Tensor:
        """The model's own outline coefficients; empty for a body without."""
        body = self.model.described.body
        return torch.tensor(() if body.outline is None else body.coefficients, dtype=torch.float64)

    def contraction(self, values: torch.Tensor | None = None) -> torch.Tensor:
        """Contraction [steps, muscles] that the run's drive causes."""
        return _Contraction.apply(self, self.values() if values is None else values)

    def contraction_from(
        self, waveform: torch.Tensor, schedule: _Schedules, step: float = 1e-6
    ) -> torch.Tensor:
        """Contraction [steps, muscles] that a waveform [n] causes, `schedule` turning its numbers into the drive.

        The drive is differentiated by central differences with a step in the waveform's numbers.
        """
        return _Waveform.apply(self, waveform, schedule, step)

    def angle(
        self,
        contraction: torch.Tensor | None = None,
        values: torch.Tensor | None = None,
        outline: torch.Tensor | None = None,
    ) -> torch.Tensor:
        """sin theta at the run's frames [n] (NaN before the start), differentiable by all three arguments.

        Raises ModelError for an outline that crosses the spine, SimulationError for a motion that cannot be followed.
        """
        return _Angle.apply(self, *self._all(contraction, values, outline))

    def shapes(
        self,
        contraction: torch.Tensor | None = None,
        values: torch.Tensor | None = None,
        outline: torch.Tensor | None = None,
    ) -> torch.Tensor:
        """Nodal positions [m] [steps + 1, nodes, 2] at the boundaries of the steps; arguments and errors as of `angle`.

        With them goes whatever depends on where the body is: how fast it swims, where it heads.
        """
        return _Shapes.apply(self, *self._all(contraction, values, outline))

    def _all(
        self, contraction: torch.Tensor | None, values: torch.Tensor | None, outline: torch.Tensor | None
    ) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
        """What is given, and the model's own of what is not."""
        return (
            self.contraction(values) if contraction is None else contraction,
            self.values() if values is None else values,
            self.outline() if outline is None else outline,
        )

    def at(self, values: torch.Tensor) -> Model:
        """The model at these values of the parameters."""
        return self.model.with_values(dict(zip(self.parameters, values.tolist(), strict=True)))

    def prepared(self, values: torch.Tensor, outline: torch.Tensor) -> PreparedRun:
        """The run at these parameter values and outline coefficients."""
        model = self.at(values)
        if not torch.equal(outline, self.outline()):
            names = outline_names(model.description.body)
            model = model.with_freed(*names).with_values(dict(zip(names, outline.tolist(), strict=True)))
        return PreparedRun(model, self.run, self.parameters)

    def voltages(self, values: torch.Tensor, schedule: DriveSchedule | None = None) -> PreparedRun:
        """The run with another voltage, for its drive alone."""
        if schedule is None:
            return PreparedRun(self.at(values), self.run, self.parameters)
        prepared = PreparedRun(self.at(values), self.run)
        prepared.schedule = schedule.of(self.model.channels, self.run.name)
        return prepared


class _Contraction(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, run: DifferentiableRun, values: torch.Tensor) -> torch.Tensor:
        ctx.run = run
        ctx.save_for_backward(values)
        return torch.from_numpy(run.voltages(values).contraction(run.balance_times))

    @staticmethod
    def backward(ctx: Any, weights: torch.Tensor) -> tuple[None, torch.Tensor]:
        (values,) = ctx.saved_tensors
        slopes = ctx.run.voltages(values).contraction_slopes(ctx.run.balance_times)
        return None, torch.einsum("sm,spm->p", weights, torch.from_numpy(slopes))


class _Waveform(torch.autograd.Function):
    @staticmethod
    def forward(
        ctx: Any, run: DifferentiableRun, waveform: torch.Tensor, schedule: _Schedules, step: float
    ) -> torch.Tensor:
        ctx.run, ctx.schedule, ctx.step = run, schedule, step
        ctx.save_for_backward(waveform)
        return _Waveform._respond(run, schedule, waveform.detach().numpy())

    @staticmethod
    def _respond(run: DifferentiableRun, schedule: _Schedules, waveform: np.ndarray) -> torch.Tensor:
        prepared = run.voltages(run.values(), schedule(waveform))
        return torch.from_numpy(prepared.contraction(run.balance_times))

    @staticmethod
    def backward(ctx: Any, weights: torch.Tensor) -> tuple[None, torch.Tensor, None, None]:
        (waveform,) = ctx.saved_tensors
        out = torch.zeros_like(waveform)
        for index in range(len(waveform)):
            shift = np.zeros(len(waveform))
            shift[index] = ctx.step
            above, below = (
                _Waveform._respond(ctx.run, ctx.schedule, waveform.detach().numpy() + sign * shift)
                for sign in (1.0, -1.0)
            )
            out[index] = (weights * (above - below)).sum() / (2 * ctx.step)
        return None, out, None, None


def _followed(
    run: DifferentiableRun, contraction: torch.Tensor, values: torch.Tensor, outline: torch.Tensor
) -> Trajectory:
    prepared = run.prepared(values.detach(), outline.detach())
    expected = (len(prepared.plan.coefficients), prepared.muscles)
    if tuple(contraction.shape) != expected:
        raise SimulationError(
            f"the contraction has the shape {tuple(contraction.shape)}; expected {expected}, one row per step: "
            "give it at balance_times"
        )
    return follow(prepared, contraction.detach().numpy())


def _by_input(ctx: Any, found: Gradient) -> tuple[None, torch.Tensor, torch.Tensor, torch.Tensor | None]:
    outline = torch.from_numpy(found.outline) if ctx.needs_input_grad[3] else None
    return None, torch.from_numpy(found.contraction), torch.from_numpy(found.parameters), outline


class _Shapes(torch.autograd.Function):
    @staticmethod
    def forward(
        ctx: Any,
        run: DifferentiableRun,
        contraction: torch.Tensor,
        values: torch.Tensor,
        outline: torch.Tensor,
    ) -> torch.Tensor:
        ctx.trajectory = _followed(run, contraction, values, outline)
        return torch.from_numpy(ctx.trajectory.shapes)

    @staticmethod
    def backward(
        ctx: Any, weights: torch.Tensor
    ) -> tuple[None, torch.Tensor, torch.Tensor, torch.Tensor | None]:
        return _by_input(
            ctx, gradient_of_shapes(ctx.trajectory, weights.detach().numpy(), ctx.needs_input_grad[3])
        )


class _Angle(torch.autograd.Function):
    @staticmethod
    def forward(
        ctx: Any,
        run: DifferentiableRun,
        contraction: torch.Tensor,
        values: torch.Tensor,
        outline: torch.Tensor,
    ) -> torch.Tensor:
        ctx.trajectory = _followed(run, contraction, values, outline)
        return torch.from_numpy(ctx.trajectory.prepared.at_frames(ctx.trajectory.series))

    @staticmethod
    def backward(
        ctx: Any, weights: torch.Tensor
    ) -> tuple[None, torch.Tensor, torch.Tensor, torch.Tensor | None]:
        plan = ctx.trajectory.prepared.plan
        at_boundaries = np.zeros(len(plan.boundaries))
        np.add.at(at_boundaries, plan.frames, weights.detach().numpy()[-len(plan.frames) :])
        return _by_input(ctx, gradient(ctx.trajectory, at_boundaries, ctx.needs_input_grad[3]))
