# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Added mass of a body of finite depth."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.effects.base import Surroundings
from hasel_sim.effects.slender import finite_length_factor
from hasel_sim.mechanics.state import DriveState, Motion
from hasel_sim.model import load_model
from hasel_sim.model.sections import FLUIDS
from hasel_sim.simulate import simulate
from hasel_sim.swimming.boxes import Boxes
from scipy.special import ellipe

DEPTH, ALONG, ACROSS, SPIN = 0.05, -0.2, 0.07, 3.0
STILL = DriveState.single(np.zeros(2), np.zeros(2), 0.0)


def test_the_wet_frequency_of_a_cantilever(cantilever, damped_sine):
    """omega_wet / omega_dry = 1 / sqrt(1 + m_a / m), m_a = rho pi H / 4 / E(e) per depth (Lamb)."""
    beam, depth = cantilever(height=0.008), 0.05
    ratio = FLUIDS["canola_oil"][0] * np.pi * depth / 4 / (beam.density * beam.height)
    ratio /= ellipe(1 - (depth / beam.length) ** 2)
    dry, wet = (
        damped_sine(*beam.ring_down(3.0, "finite_depth_added_mass", coefficient=c), beam.frequency)[0]
        for c in (0.0, 1.0)
    )
    assert wet / dry == pytest.approx(1 / np.sqrt(1 + ratio), rel=2e-3)


def test_a_disc_carries_two_thirds_of_what_strips_of_it_would():
    """Lamb: 8/3 rho a^3 for a disc of radius a, whose strips add up to 4/3 pi rho a^3; all of it for a slender body."""
    disc = Surroundings(1000.0, 1e-3, 0.1, 0.1)
    assert finite_length_factor(disc) == pytest.approx((8 / 3) / (4 / 3 * np.pi))
    assert finite_length_factor(replace(disc, length=100.0)) == pytest.approx(1.0, abs=1e-5)


@pytest.fixture
def plate(cantilever):
    """A straight body that turns as it goes on: model, length, nodes, velocities [nodes, 2], mass of the fluid."""
    beam = cantilever()
    model = beam.model("finite_depth_added_mass", coefficient=1.0)
    nodes = Builder(model).system().nodes
    velocity = np.array([ALONG, ACROSS]) + SPIN * np.stack([-nodes[:, 1], nodes[:, 0]], axis=1)
    mass = FLUIDS["canola_oil"][0] * np.pi * DEPTH / 4 / ellipe(1 - (DEPTH / beam.length) ** 2)
    return model, beam.length, nodes, velocity, mass


def _forces(model, velocity, acceleration) -> np.ndarray:
    """Forces of the fluid on the nodes of the straight body [N/m] [nodes, 2]."""
    system = Builder(model).system()
    motion = Motion(system.nodes[..., None], velocity[..., None], acceleration[..., None])
    out = np.zeros((*system.nodes.shape, 1))
    for law in system.forces:
        law.add_force(motion, STILL, out)
    return out[..., 0]


def test_what_the_body_spends_is_what_the_fluid_has(plate):
    """Power of the forces on a body that goes on, drifts and turns: minus the rate of the fluid's energy m w^2 / 2."""
    model, length, nodes, velocity, mass = plate
    growth, turning = 0.8, 5.0
    acceleration = np.array([0.3, growth]) + turning * np.stack([-nodes[:, 1], nodes[:, 0]], axis=1)
    acceleration -= SPIN**2 * nodes
    along = np.linspace(0.0, length, 20001)
    across = ACROSS + SPIN * along
    rate = np.trapezoid(mass * across * (growth + turning * along - SPIN * ALONG), along)
    assert np.sum(_forces(model, velocity, acceleration) * velocity) == pytest.approx(-rate, rel=1e-6)


def test_a_body_that_drifts_is_turned_across_its_way(plate):
    """Munk's moment on a plate in a stream: m u w per length, and no force (Kirchhoff)."""
    model, length, nodes, _, mass = plate
    still = np.zeros_like(nodes)
    forces = _forces(model, still + np.array([ALONG, ACROSS]), still)
    moment = np.sum(nodes[:, 0] * forces[:, 1] - nodes[:, 1] * forces[:, 0])
    assert moment == pytest.approx(-mass * ALONG * ACROSS * length, rel=1e-6)
    assert forces.sum(axis=0) == pytest.approx([0.0, 0.0], abs=1e-9 * mass)


def test_a_free_swimmer_with_it_can_be_followed():
    """Half as many steps again change nothing that one would see: no energy comes from nowhere."""
    model = (
        load_model("swimmer_in_oil").without_effects("reactive_force").with_effects("finite_depth_added_mass")
    )
    model = model.with_values({"finite_depth_added_mass.coefficient": 1.0})
    run = Boxes(4500, 4500, 2.5).run(model, 2.8)
    usual, fine = (simulate(model.with_numerics(steps_per_second=n), run).sin_theta for n in (240, 480))
    assert np.abs(usual - fine).mean() < 0.0015
