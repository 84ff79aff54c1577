# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Gradients by the adjoint against gradcheck, forward sensitivities and central differences."""

from pathlib import Path

import numpy as np
import pytest
import torch
from hasel_sim.adjoint import DifferentiableRun
from hasel_sim.adjoint.gradient import follow
from hasel_sim.errors import ModelError, SimulationError
from hasel_sim.model import load_model
from hasel_sim.prepared_run import PreparedRun
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

FRICTION = f"{Path(__file__).parent}/film_friction.py:FilmFriction"
EFFECTS = ("quadratic_drag", "soft_modulus", "viscoelastic_creep", "muscle_asymmetry", "marker_offset")


def _weights(frames: int) -> torch.Tensor:
    return torch.from_numpy(np.random.default_rng(3).normal(size=frames))


def _model(swimmer, effects=(), **numerics):
    model = swimmer.with_numerics(tolerance_m=1e-14, mesh_density=0.5, **numerics).with_effects(*effects)
    typical = {f"{e.id}.{p.name}": p.typical for e in model.effects for p in e.parameters}
    return model.with_values(typical)


def _central_difference(function, at: torch.Tensor, index: int, step: float) -> float:
    """Fourth-order difference of a scalar function by one entry."""

    def value(factor):
        moved = at.clone()
        moved.view(-1)[index] += factor * step
        return float(function(moved))

    return (8 * (value(1) - value(-1)) - (value(2) - value(-2))) / (12 * step)


def test_gradcheck_passes_on_a_small_body(swimmer, boxes):
    """By the whole activation series, a parameter and the outline, on a coarse mesh and 10 steps."""
    model = _model(swimmer, ["soft_modulus"], steps_per_second=120.0).with_numerics(mesh_density=0.25)
    run = DifferentiableRun(model, boxes(duration=10 / 120), list(model.parameters)[-1:])
    contraction = torch.full((10, 2), 0.02, dtype=torch.float64)
    contraction[:, 1] = 0.005
    inputs = [contraction, run.values(), run.outline()]
    for tensor in inputs:
        tensor.requires_grad_()
    assert torch.autograd.gradcheck(run.angle, inputs, eps=1e-5, atol=1e-7, rtol=1e-5)


def test_gradient_by_the_activation_series_agrees_with_differences(swimmer, boxes):
    """To 1e-6, with drag, creep and an observation effect in the model."""
    model = _model(swimmer, EFFECTS)
    run = DifferentiableRun(model, boxes(duration=0.4))
    contraction = run.contraction().detach().requires_grad_()
    weights = _weights(len(run.run.time))
    (run.angle(contraction) * weights).sum().backward()
    largest = contraction.grad.abs().max()
    for index in (0, 41, 90, 133):
        expected = _central_difference(
            lambda c: (run.angle(c) * weights).sum(), contraction.detach(), index, 1e-4
        )
        assert abs(contraction.grad.view(-1)[index] - expected) < 1e-6 * largest


@pytest.mark.parametrize(
    "effects", [EFFECTS, ("added_mass", "linear_drag", "tether", "strain_softening", FRICTION)]
)
def test_gradient_by_every_parameter_agrees_with_the_forward_sensitivities(effects, swimmer, boxes):
    """Drive, force, material, branches and observation at once, to 1e-6 of each; a law of the user's own too."""
    model = _model(swimmer, effects)
    run, names = boxes(duration=0.4), list(model.parameters)
    differentiable = DifferentiableRun(model, run, names)
    values = differentiable.values().requires_grad_()
    weights = _weights(len(run.time))
    (differentiable.angle(values=values) * weights).sum().backward()
    forward = simulate(model, run, names)
    expected = weights.numpy() @ forward.slopes
    scale = np.abs(weights.numpy()[:, None] * forward.slopes).sum(axis=0)
    assert np.abs(values.grad.numpy() - expected).max() > 0
    assert np.all(np.abs(values.grad.numpy() - expected) <= 1e-6 * scale), dict(
        zip(names, scale, strict=True)
    )


def test_gradient_by_the_stress_of_the_start_agrees_with_the_forward_sensitivities():
    """To 1e-6 of each, for a body that is let go while its stress still relaxes."""
    model = _model(load_model("beam"), ("initial_relaxation", "soft_modulus", "pre_bend"))
    run = Run("let go", np.arange(0.0, 0.3, 1 / 60), None, "static_equilibrium", 1.4)
    names = [name for name in model.parameters if "." in name]
    differentiable = DifferentiableRun(model, run, names)
    values = differentiable.values().requires_grad_()
    weights = _weights(len(run.time))
    (differentiable.angle(values=values) * weights).sum().backward()
    slopes = simulate(model, run, names).slopes
    scale = np.abs(weights.numpy()[:, None] * slopes).sum(axis=0)
    assert np.all(scale > 0)
    assert np.all(np.abs(values.grad.numpy() - weights.numpy() @ slopes) <= 1e-6 * scale)


def test_the_angle_is_that_of_simulate(swimmer, boxes):
    """The same numbers, forward."""
    run = boxes(duration=0.2)
    found = DifferentiableRun(swimmer, run).angle().numpy()
    assert found == pytest.approx(simulate(swimmer, run).sin_theta, abs=1e-12)


@pytest.mark.parametrize("effects", [(), ("quadratic_drag", "viscoelastic_creep")])
def test_gradient_by_the_outline_agrees_with_differences(effects, swimmer, boxes):
    """To 1e-6; nodes, masses, skin, start and branches move with it."""
    model = _model(swimmer, effects)
    run = DifferentiableRun(model, boxes(duration=0.3))
    outline = run.outline().requires_grad_()
    weights = _weights(len(run.run.time))
    (run.angle(outline=outline) * weights).sum().backward()
    for index in range(len(outline)):
        expected = _central_difference(
            lambda o: (run.angle(outline=o) * weights).sum(), outline.detach(), index, 3e-4
        )
        assert float(outline.grad[index]) == pytest.approx(expected, rel=1e-6)


def test_gradient_by_numbers_of_the_shape_agrees_with_differences_and_forward(swimmer, boxes):
    """Spine, fin and outline as parameters: to 1e-6 of differences, the adjoint's and along with the steps."""
    names = (
        "body.spine.thickness_m",
        "body.spine.fin_length_m",
        "body.outline.largest_half_height_m",
        "body.outline.coefficients.1",
    )
    model, run = _model(swimmer, ("quadratic_drag",)).with_freed(*names), boxes(duration=0.3)
    differentiable = DifferentiableRun(model, run, names)
    values = differentiable.values().requires_grad_()
    weights = _weights(len(run.time))
    (differentiable.angle(values=values) * weights).sum().backward()
    forward = weights.numpy() @ simulate(model, run, names).slopes
    for index in range(len(names)):
        expected = _central_difference(
            lambda v: (differentiable.angle(values=v) * weights).sum(),
            values.detach(),
            index,
            1e-4 * values[index].item(),
        )
        assert float(values.grad[index]) == pytest.approx(expected, rel=2e-6)
        assert forward[index] == pytest.approx(expected, rel=2e-6)


def test_the_start_in_equilibrium_is_differentiated_too(rectangle, tip_force):
    """A beam let go from a load: gradient by the load's size, against differences."""
    from hasel_sim.run import Run

    model = rectangle(
        0.1, 0.02, gravity=3.0, effects=[tip_force], values={"tip_force.force": 0.5}, tolerance_m=1e-14
    )
    run = Run("", np.arange(20) / 120, initial_state="static_equilibrium", initial_load_factor=0.4)
    differentiable = DifferentiableRun(model, run, ["tip_force.force"])
    values = differentiable.values().requires_grad_()
    differentiable.angle(values=values).sum().backward()
    expected = _central_difference(lambda v: differentiable.angle(values=v).sum(), values.detach(), 0, 1e-3)
    assert float(values.grad[0]) == pytest.approx(expected, rel=1e-6)
    forward = simulate(model, run, ["tip_force.force"]).slopes.sum()
    assert forward == pytest.approx(expected, rel=1e-6)


def test_a_waveform_reaches_the_angle(swimmer, boxes):
    """The gradient by a switching time, through drive and body, against differences."""
    from hasel_sim.drive.schedule import DriveSchedule

    run = DifferentiableRun(_model(swimmer), boxes(duration=0.4))

    def schedule(waveform):
        return DriveSchedule(np.array([0.0, waveform[0]]), np.array([[5500.0, 0.0], [0.0, 5500.0]]))

    def loss(waveform):
        return run.angle(run.contraction_from(waveform, schedule)).square().sum()

    waveform = torch.tensor([0.1512], dtype=torch.float64, requires_grad=True)
    loss(waveform).backward()
    expected = _central_difference(loss, waveform.detach(), 0, 1e-5)
    assert float(waveform.grad[0]) == pytest.approx(expected, rel=1e-5)


def test_what_does_not_fit_is_refused(swimmer, boxes):
    """A contraction of another length, an outline through the spine."""
    run = DifferentiableRun(swimmer, boxes(duration=0.1))
    with pytest.raises(SimulationError, match=r"expected \(24, 2\).*balance_times"):
        run.angle(torch.zeros((3, 2), dtype=torch.float64))
    with pytest.raises(ModelError, match="crosses the spine"):
        run.angle(outline=torch.tensor([0.3, -1.0, 0.0, 0.0, 0.0, 0.0], dtype=torch.float64))


def test_a_divided_step_is_gone_back_through_too(swimmer, boxes):
    """A contraction of 0.2 at once, which 240 steps a second cannot follow whole: as the forward sensitivities."""
    model = swimmer.with_values({"amplitude_5500": 0.4, "slope": 1e3}).with_numerics(tolerance_m=1e-11)
    run, names = boxes(duration=0.34), ["amplitude_5500"]
    differentiable = DifferentiableRun(model, run, names)
    trajectory = follow(PreparedRun(model, run), differentiable.contraction().numpy())
    assert any(len(parts) > 1 for parts in trajectory.steps)
    values = differentiable.values().requires_grad_()
    weights = _weights(len(run.time))
    (differentiable.angle(values=values) * weights).sum().backward()
    expected = weights.numpy() @ simulate(model, run, names).slopes
    assert values.grad.numpy() == pytest.approx(expected, rel=1e-6)
