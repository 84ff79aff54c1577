# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Reactive force of a slender body."""

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.effects.registry import find_effects
from hasel_sim.mechanics.state import DriveState, Motion
from hasel_sim.model.sections import FLUIDS

DEPTH = 0.05
STILL = DriveState.single(np.zeros(2), np.zeros(2), 0.0)


def test_the_wet_frequency_of_a_cantilever(cantilever, damped_sine):
    """omega_wet / omega_dry = 1 / sqrt(1 + m_a / m), m_a = rho pi H / 4 per depth, in water and in oil."""
    beam = cantilever(height=0.008)
    ratio = FLUIDS["canola_oil"][0] * np.pi * DEPTH / 4 / (beam.density * beam.height)
    dry, wet = (
        damped_sine(*beam.ring_down(3.0, "reactive_force", coefficient=c), beam.frequency)[0]
        for c in (0.0, 1.0)
    )
    assert wet / dry == pytest.approx(1 / np.sqrt(1 + ratio), rel=3e-3)


def _force(cantilever_model, velocity, acceleration) -> np.ndarray:
    """Sum of the forces of the fluid on the straight body [N/m], for nodal fields [nodes, 2]."""
    system = Builder(cantilever_model).system()
    motion = Motion(system.nodes[..., None], velocity[..., None], acceleration[..., None])
    out = np.zeros((*system.nodes.shape, 1))
    for law in system.forces:
        law.add_force(motion, STILL, out)
    return out[..., 0].sum(axis=0)


def test_the_sum_on_the_mesh_is_lighthills_balance(cantilever):
    """Momentum that grows along the body and what is shed at the tail add up to the force on the nodes."""
    beam = cantilever()
    model = beam.model("reactive_force", coefficient=1.0)
    x = Builder(model).system().nodes[:, 0]
    z, mass = x / beam.length, FLUIDS["canola_oil"][0] * np.pi * DEPTH / 4
    u, w, growth = -0.2, 0.3 * z**2, 1.5 * z**2
    velocity = np.stack([np.full_like(z, u), w], axis=1)
    acceleration = np.stack([np.zeros_like(z), growth], axis=1)
    turning = 0.6 * z / beam.length
    fine = np.linspace(0.0, 1.0, 20001)
    spin = 0.6 * fine / beam.length
    expected_y = -mass * beam.length * np.trapezoid(1.5 * fine**2 - spin * u, fine) + mass * u * 0.3
    expected_x = mass * beam.length * np.trapezoid(0.3 * fine**2 * spin, fine) - 0.5 * mass * 0.3**2
    assert turning.max() == pytest.approx(spin.max())
    assert _force(model, velocity, acceleration) == pytest.approx(
        [expected_x, expected_y], rel=1e-6, abs=1e-7
    )


def test_the_two_inertias_of_the_fluid_do_not_stand_side_by_side(coarse_swimmer):
    """Either fluid that is shed, or fluid that only goes to and fro."""
    with pytest.raises(Exception, match="does the same as 'reactive_force'"):
        coarse_swimmer.with_effects("reactive_force", "finite_depth_added_mass")
    assert find_effects(("reactive_force",))[0].has_flux
