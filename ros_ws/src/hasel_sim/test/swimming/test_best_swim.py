# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The waveform, and the body, that swim best.

Speed, heading and power as differentiable functions.
"""

from pathlib import Path

import numpy as np
import pytest
import torch
from hasel_sim.errors import SimulationError
from hasel_sim.model import load_model
from hasel_sim.swimming.best_swim import DifferentiableSwim, best_swim, period_means
from hasel_sim.swimming.boxes import Boxes, waveform_rows
from hasel_sim.swimming.free_swim import free_swim
from hasel_sim.swimming.search import Task

ASYMMETRIC = Path(__file__).parents[2] / "docs" / "bodies" / "asymmetric_fish.yaml"
START = Boxes(5000.0, 5000.0, 1.5)


@pytest.fixture(scope="module")
def lopsided():
    """A fish whose lower muscle is a tenth weaker, on a coarse mesh."""
    return load_model(ASYMMETRIC).with_numerics(mesh_density=0.4, steps_per_second=120.0)


def test_unequal_voltages_straighten_an_asymmetric_fish(lopsided):
    """It turns under equal voltages; the weaker muscle gets more, and it swims straight and no slower."""
    found = best_swim(lopsided, START, Task(turning=0.0, duration=3.0), most=6)
    assert abs(np.degrees(found.start.turning)) > 0.3
    assert abs(np.degrees(found.best.turning)) < 0.02
    assert found.best.drive.second > found.best.drive.first + 100.0
    assert found.best.speed >= found.start.speed
    assert len(found.tried) < 12


def test_the_cheapest_swim_is_not_the_fastest(lopsided):
    """Less work per distance than at the start, at lower voltages; the sentence says what was found."""
    task = Task("cost", duration=3.0)
    found = best_swim(lopsided, START, task, most=3)
    assert found.best.cost_of_transport < 0.98 * found.start.cost_of_transport
    assert max(found.best.drive.first, found.best.drive.second) < 4500.0
    assert found.best.speed < found.start.speed
    assert "J/(kg m)" in str(found) and "swims with gradients" in str(found)


def test_a_fish_is_steered_to_a_heading(lopsided):
    """Its unequal voltages point it five degrees to the right after three seconds; what cannot be reached is said."""
    found = best_swim(lopsided, START, Task(heading=np.radians(-5.0), duration=3.0), most=6)
    assert np.degrees(found.start.heading) > -2.0
    assert np.degrees(found.best.heading) == pytest.approx(-5.0, abs=0.05) and not found.missed
    confirmed = free_swim(lopsided, found.best.drive.run(lopsided, 3.0), 1.5)
    assert np.degrees(confirmed.mean_heading(1.5)) == pytest.approx(-5.0, abs=0.3)
    far = best_swim(lopsided, START, Task(heading=np.radians(-90.0), duration=3.0), most=1)
    assert "The heading of -90° is not reached" in str(far)


@pytest.mark.slow
def test_a_better_body_is_found_and_described(lopsided):
    """Outline and fin: faster under the same boxes, with as much body as before, also on a mesh made for it."""
    fin, quick = "body.spine.fin_length_m", Boxes(5000.0, 5000.0, 2.0)
    task = Task(vary=("outline", fin), ranges={fin: (0.02, 0.05)}, duration=2.1)
    found = best_swim(lopsided, quick, task, most=1)
    assert found.best.speed > 1.05 * found.start.speed
    assert found.best.drive == quick and "body.spine.fin_length_m 0.0" in str(found.best)
    improved = found.improved(lopsided)
    assert improved.parameters == lopsided.parameters
    before, after = (model.description.body for model in (lopsided, improved))
    s = np.linspace(0.0, 1.0, 201)
    heights = [body.half_heights(s) for body in (before, after)]
    assert heights[1].mean() == pytest.approx(heights[0].mean(), rel=1e-3)
    assert np.all(np.abs(heights[1] / heights[0] - 1.25) < 0.76)
    assert 0.02 <= after.spine.fin_length_m <= 0.05
    assert improved.description.markers["tail"].x_m == pytest.approx(0.16 + after.spine.fin_length_m)
    swum = [free_swim(model, quick.run(model, 2.1), 2.0).speed for model in (lopsided, improved)]
    assert swum[1] > 1.05 * swum[0]


@pytest.mark.parametrize(
    ("task", "said"),
    [
        ({"goal": "fame"}, "'fame' is no goal; expected one of speed, cost"),
        ({"vary": ("voltage",)}, "'voltage' cannot be varied; expected some of first, second, duty, phase"),
        (
            {"vary": ("outline", "body.outline.coefficients.0")},
            "expected one of them, as the outline sets all",
        ),
        ({"vary": ("duty",), "ranges": {"phase": (0.3, 0.4)}}, "of something that is varied"),
        ({"vary": ("duty",), "ranges": {"duty": (0.3, 0.4)}}, "duty starts at 1; expected 0.3 to 0.4"),
        ({"heading": 0.1, "turning": 0.1}, "expected one of them, since the one sets the other"),
        ({"largest": 4000.0}, "first starts at 5000; expected 1600 to 4000"),
    ],
)
def test_a_task_that_makes_no_sense_is_refused(lopsided, task, said):
    """An unknown goal, an unknown number, a start above the largest voltage."""
    with pytest.raises(SimulationError, match=said):
        best_swim(lopsided, START, Task(**task))


def test_the_waveform_as_a_file():
    """A row per switch, each until the next, and rest at the end."""
    lines = waveform_rows(Boxes(5169.67, 5500.0, 2.0), 1.0, ("upper", "lower")).splitlines()
    assert lines[0] == "time_s,voltage_upper_v,voltage_lower_v"
    assert lines[1:] == ["0,5169.67,0", "0.25,0,5500", "0.5,5169.67,0", "0.75,0,5500", "1,0,0"]


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
