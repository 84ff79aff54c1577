# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A plate on the tip: its mass and its rotary inertia against beam theory."""

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.dynamics.system import linearise
from hasel_sim.mechanics.state import DriveState, Memory, Motion
from scipy.linalg import eigh
from scipy.optimize import brentq

LENGTH, HEIGHT, STIFFNESS, DENSITY = 0.1, 0.004, 1e5, 1000.0
BENDING = STIFFNESS / (1 - 0.3**2) * HEIGHT**3 / 12
LINE = DENSITY * HEIGHT


def _with_plate(model, mass: float, inertia: float):
    body = model.description.body
    plate = {"mass_kg_per_m": mass, "rotary_inertia_kg_m": inertia}
    changed = type(body).model_validate({**body.model_dump(), "tip_plate": plate})
    return type(model)(
        model.description.model_copy(update={"body": changed}), model.effects, model.parameters
    )


def _frequency(model) -> float:
    """First angular frequency [rad/s], from stiffness and mass at rest."""
    builder = Builder(model)
    system, nodes = builder.system(), builder.nodes[..., None]
    still = np.zeros_like(nodes)
    line = linearise(
        system, Motion(nodes, still, still), DriveState.single(np.zeros(0), np.zeros(0), 0.0), Memory()
    )
    columns = np.eye(2 * len(still)).reshape(-1, *still.shape)
    stiffness = line.along(columns, np.zeros_like(columns), np.zeros_like(columns)).reshape(len(columns), -1)
    mass = line.along(np.zeros_like(columns), np.zeros_like(columns), columns).reshape(len(columns), -1)
    free = slice(2 * system.held, None)
    return float(
        np.sqrt(eigh(stiffness[free, free], mass[free, free], eigvals_only=True, subset_by_index=[0, 0])[0])
    )


def _beam_theory(mass: float, inertia: float) -> float:
    """First angular frequency of a clamped Euler-Bernoulli beam with mass and rotary inertia at its end."""

    def determinant(z: float) -> float:
        omega2 = BENDING * (z / LENGTH) ** 4 / LINE
        c, s, ch, sh, k = np.cos(z), np.sin(z), np.cosh(z), np.sinh(z), z / LENGTH
        # w = A (cosh - cos) + B (sinh - sin); moment = omega^2 J w', shear = -omega^2 m w at the end
        moment = [BENDING * k**2 * (ch + c) - omega2 * inertia * k * (sh + s)]
        moment += [BENDING * k**2 * (sh + s) - omega2 * inertia * k * (ch - c)]
        shear = [BENDING * k**3 * (sh - s) + omega2 * mass * (ch - c)]
        shear += [BENDING * k**3 * (ch + c) + omega2 * mass * (sh - s)]
        return moment[0] * shear[1] - moment[1] * shear[0]

    z = brentq(determinant, 0.3, 1.8751041)
    return float(np.sqrt(BENDING / LINE) * (z / LENGTH) ** 2)


@pytest.mark.parametrize(("mass", "inertia"), [(0.2, 0.0), (0.4, 0.0), (0.2, 2e-4), (0.0, 5e-4)])
def test_the_first_frequency_is_that_of_beam_theory(mass, inertia, rectangle):
    """Within 1 % of Euler and Bernoulli, for a slender beam."""
    model = rectangle(LENGTH, HEIGHT, youngs_modulus=STIFFNESS, poissons_ratio=0.3)
    assert _frequency(_with_plate(model, mass, inertia)) == pytest.approx(
        _beam_theory(mass, inertia), rel=0.01
    )


def test_the_plate_hangs_with_its_weight(rectangle, equilibrium_of):
    """A tip mass bends the beam by m g L^3 / 3 E I more than its own weight does."""
    model = rectangle(LENGTH, HEIGHT, youngs_modulus=STIFFNESS, poissons_ratio=0.3, gravity=0.02)
    own, mesh = equilibrium_of(model)
    loaded, _ = equilibrium_of(_with_plate(model, 0.3, 1e-4))
    tip = mesh.tip[len(mesh.tip) // 2]
    expected = -0.3 * 0.02 * LENGTH**3 / (3 * BENDING)
    assert loaded[tip, 1] - own[tip, 1] == pytest.approx(expected, rel=0.01)
