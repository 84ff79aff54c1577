"""Speed, heading and power as differentiable functions."""

import numpy as np
import pytest
import torch
from hasel_sim.errors import SimulationError
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.free_swim import free_swim
from hasel_sim.swimming.goal import DifferentiableSwim, period_means

DRIVE, DURATION = Boxes(5500.0, 4500.0, 2.5, duty=0.9), 2.0


def _scheduled(model):
    def schedule(x):
        return Boxes(5500.0 * x[0], 5500.0 * x[1], 2.5, x[2], x[3]).schedule(DURATION, model.channels)

    return schedule


def test_gradients_agree_with_differences_of_whole_swims(fish):
    """By voltage, duty and phase, and by a parameter of the fluid, through three hundred steps with shed momentum."""
    model = fish.with_numerics(steps_per_second=120.0)
    run, name = DRIVE.run(model, DURATION), "reactive_force.coefficient"
    swim = DifferentiableSwim(model, run, 2.5, 2, (name,))

    def found(x: np.ndarray):
        numbers = torch.tensor(x, requires_grad=True)
        contraction = swim.differentiable.contraction_from(numbers[:4], _scheduled(model))
        of = swim(contraction, numbers[4:])
        return numbers, (of.speed, of.turning, of.power)

    start = np.array([0.6, 0.55, 0.9, 0.52, 1.0])
    numbers, parts = found(start)
    slopes = [torch.autograd.grad(part, numbers, retain_graph=True)[0].numpy() for part in parts]
    for place in (1, 2, 3, 4):
        step = 1e-5 * np.eye(5)[place]
        above, below = (found(start + sign * step)[1] for sign in (1.0, -1.0))
        for row, (up, down) in enumerate(zip(above, below, strict=True)):
            expected = (up.item() - down.item()) / 2e-5
            assert slopes[row][place] == pytest.approx(
                expected, rel=2e-2, abs=2e-3 * np.abs(slopes[row]).max()
            )


def test_gradients_by_the_shape_agree_with_differences_of_whole_swims(fish):
    """By outline, spine, fin and depth: speed, heading, power and mass, whose muscles and fluid change with them."""
    names = (
        "body.outline.coefficients.2",
        "body.spine.thickness_m",
        "body.spine.fin_length_m",
        "body.depth_m",
    )
    model = fish.with_freed(*names).with_numerics(tolerance_m=1e-12)
    swim = DifferentiableSwim(model, DRIVE.run(model, DURATION), 2.5, 2, names)
    contraction = swim.differentiable.contraction().detach()

    def found(x: torch.Tensor) -> list[torch.Tensor]:
        of = swim(contraction, x)
        return [of.speed, of.turning, of.heading, of.power, of.mass, of.cost_of_transport]

    start = swim.differentiable.values()
    numbers = start.clone().requires_grad_()
    slopes = [
        torch.autograd.grad(part, numbers, retain_graph=True)[0].numpy() for part in found(numbers)
    ] * start.numpy()
    for place in range(len(names)):
        step = torch.zeros_like(start)
        step[place] = 1e-6 * start[place]
        above, below = (found(start + sign * step) for sign in (1.0, -1.0))
        expected = np.array([(a - b).item() / 2e-6 for a, b in zip(above, below, strict=True)])
        assert slopes[:, place] == pytest.approx(expected, rel=1e-4, abs=1e-5)


def test_it_is_the_swim_that_is_measured(fish):
    """The same speed, turning and power as from the shapes of a simulation."""
    run = DRIVE.run(fish, DURATION)
    swim = DifferentiableSwim(fish, run, 2.5, 2)
    found, measured = swim(swim.differentiable.contraction()), free_swim(fish, run, 2.5)
    assert found.speed.item() == pytest.approx(measured.speed, rel=0.03)
    assert found.turning.item() == pytest.approx(measured.turning, rel=0.1, abs=2e-3)
    assert found.power.item() == pytest.approx(measured.power, rel=0.05)
    assert found.mass.item() == pytest.approx(measured.mass)
    assert found.heading.item() == pytest.approx(measured.mean_heading(2.5), rel=0.02, abs=1e-4)
    with pytest.raises(SimulationError, match="expected more than 9"):
        DifferentiableSwim(fish, run, 2.5, 9)


def test_means_over_periods():
    """Exact for a straight line, blind to the oscillation."""
    time = np.linspace(0.0, 2.0, 401)
    rows = period_means(time, 2.0, 3)
    assert rows @ (3.0 * time + 1.0) == pytest.approx(3.0 * np.array([0.75, 1.25, 1.75]) + 1.0)
    assert rows @ np.sin(2 * np.pi * 2.0 * time) == pytest.approx(np.zeros(3), abs=1e-12)
