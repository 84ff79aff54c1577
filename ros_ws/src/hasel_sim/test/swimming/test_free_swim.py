# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Speed, heading, power and cost of transport of a free body."""

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.state import DriveState, Motion
from hasel_sim.model import load_model
from hasel_sim.run import Run
from hasel_sim.simulate import simulate
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.free_swim import free_swim, measured

EQUAL, UNEQUAL = Boxes(5500.0, 5500.0, 2.0), Boxes(5500.0, 4000.0, 2.0)


@pytest.fixture(scope="module")
def straight(fish):
    """A swim of equal muscles."""
    return free_swim(fish, EQUAL.run(fish, 4.0), EQUAL.frequency)


def test_it_swims_nose_first_and_settles(fish, straight):
    """Towards -x, where its nose is; its mass is that of its outline and fin; the sentence says how far."""
    assert straight.position[-1, 0] - straight.position[0, 0] == pytest.approx(-straight.distance, rel=1e-2)
    assert 0.04 < straight.speed < 0.1
    assert straight.earlier == pytest.approx(straight.speed, rel=0.02)
    assert straight.cost_of_transport == pytest.approx(straight.power / (straight.mass * straight.speed))
    x = np.linspace(0.0, 1.0, 4001)
    body = fish.description.body
    area = 0.16 * 2 * 0.0075 * np.trapezoid(np.polyval(body.coefficients[::-1], x), x) + 0.03 * 0.001
    assert straight.mass == pytest.approx(900.0 * area * body.depth_m, rel=5e-3)
    assert str(straight).startswith(f"{1e3 * straight.distance:.1f} mm in 4 s")


def test_the_stronger_muscle_turns_it_to_its_side(fish):
    """A body that is bent upwards more turns that way; the mirrored drive mirrors the way."""
    one = free_swim(fish, UNEQUAL.run(fish, 4.0), 2.0)
    flipped = Boxes(UNEQUAL.second, UNEQUAL.first, 2.0, phase=-0.5)
    other = free_swim(fish, flipped.run(fish, 4.0), 2.0)
    assert abs(one.turning) > np.radians(0.5)
    assert np.sign(one.turning) == -np.sign(other.turning)


def test_a_turned_swimmer_swims_the_same_way_turned(fish, straight):
    """Speed, power and turning do not depend on where it points; its way turns with it."""
    run = UNEQUAL.run(fish, 4.0)
    rest = simulate(fish, Run("rest", run.time[:2]), keep_shapes=True).shapes[0]
    there = np.array([[0.0, 1.0], [-1.0, 0.0]])
    turned = Run(run.name, run.time, run.schedule, "held_shape", initial_shape=rest @ there)
    one = free_swim(fish, run, 2.0)
    other = measured(fish, simulate(fish, turned, keep_shapes=True), 2.0)
    assert other.position == pytest.approx(one.position @ there, abs=1e-6)
    assert other.turned - np.pi / 2 == pytest.approx(one.turned, abs=1e-5)
    assert (other.speed, other.power) == pytest.approx((one.speed, one.power), rel=1e-4)


def test_the_muscles_pay_what_fluid_and_material_take(fish):
    """Over a settled period the work of the muscles is that against the fluid, where the material hardly takes any."""
    names = [f"material.{part}.retardation_time_s" for part in ("soft", "spine")]
    model = fish.with_freed(*names).with_values(dict.fromkeys(names, 0.0005))
    model = model.with_numerics(steps_per_second=480.0)
    run = EQUAL.run(model, 3.0)
    fine = Run(run.name, np.arange(3 * 480 + 1) / 480, run.schedule)
    simulation = simulate(model, fine, keep_shapes=True)
    swim = measured(model, simulation, EQUAL.frequency)
    velocity = np.gradient(simulation.shapes, 1 / 480, axis=0)
    acceleration = np.gradient(velocity, 1 / 480, axis=0)
    power = []
    system, still = Builder(model).system(), DriveState.single(np.zeros(2), np.zeros(2), 0.0)
    for x, v, a in zip(simulation.shapes[-482:-2], velocity[-482:-2], acceleration[-482:-2], strict=True):
        force = np.zeros((*x.shape, 1))
        for law in system.forces:
            law.add_force(Motion(x[..., None], v[..., None], a[..., None]), still, force)
        power.append(-model.description.body.depth_m * np.sum(force[..., 0] * v))
    assert 0.9 * swim.power < np.mean(power) < 1.01 * swim.power


def test_what_does_not_swim_is_refused(fish):
    """A dry body, one without effects of its fluid, one that is clamped."""
    run = EQUAL.run(fish, 2.0)
    with pytest.raises(SimulationError, match="names no fluid; expected a section medium"):
        free_swim(load_model("swimmer"), run, 2.0)
    with pytest.raises(SimulationError, match="has no effect of its fluid"):
        free_swim(load_model("swimmer").in_medium("water", 0.05), run, 2.0)
