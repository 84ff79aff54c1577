# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Stresses and moduli at one Gauss point against differences of the energy, and against theory."""

import numpy as np
import pytest
from hasel_sim.mechanics import constitutive
from hasel_sim.mechanics.branches import Branches
from hasel_sim.simd import lane_tuple
from scipy.optimize import minimize_scalar

SHEAR, LAME, VISCOUS_SHEAR, VISCOUS_LAME, FIBRE = 22e3, 200e3, 440.0, 4000.0, 65e3
CONTRACTION = 0.1
F = np.array([1.15, 0.2, -0.1, 0.95])
RATE = np.array([0.3, -0.5, 0.8, -0.2])
STEP = 1e-6
ONE = lane_tuple(1)


def _energy(f: np.ndarray, plane_stress: bool) -> float:
    a, b, c, d = f
    J, squares = a * d - b * c, f @ f
    fibre = 0.5 * FIBRE * (np.hypot(a, c) - (1 - CONTRACTION)) ** 2

    def solid(thickness: float) -> float:
        log_volume = np.log(J * thickness)
        return 0.5 * SHEAR * (squares + thickness**2 - 3 - 2 * log_volume) + 0.5 * LAME * log_volume**2

    if not plane_stress:
        return fibre + solid(1.0)
    return fibre + minimize_scalar(solid, bounds=(0.3, 3.0), method="bounded", options={"xatol": 1e-12}).fun


def _point(values) -> np.ndarray:
    return np.array(values, dtype=float)[None, None, :, None]


def _arguments(viscous: bool, plane_stress: bool, history=(0.0, 0.0, 0.0), branch=(0.0, 0.0)):
    table = np.array([[SHEAR, LAME, VISCOUS_SHEAR * viscous, VISCOUS_LAME * viscous, *branch, FIBRE]])
    contraction = np.array([[0.0], [CONTRACTION], [0.0]])
    return table[..., None], np.array([1]), contraction, _point(history), plane_stress


def _stress(f, rate, arguments) -> np.ndarray:
    out = np.empty((1, 1, 4, 1))
    constitutive.first_piola(_point(f), _point(rate), *arguments, out, ONE)
    return out[0, 0, :, 0]


def _difference(function, at) -> np.ndarray:
    """Central differences of a vector function, [values, variables]."""
    moved = [STEP * e for e in np.eye(len(at))]
    return np.array([(function(at + d) - function(at - d)) / (2 * STEP) for d in moved]).T


@pytest.mark.parametrize("plane_stress", [False, True])
def test_stress_is_the_derivative_of_the_energy(plane_stress):
    """First Piola stress of solid and fibre against differences of W."""
    expected = _difference(lambda f: _energy(f, plane_stress), F)
    found = _stress(F, 0 * RATE, _arguments(False, plane_stress))
    assert found == pytest.approx(expected, rel=1e-5, abs=0.1)


def test_viscous_stress_is_that_of_kelvin_and_voigt():
    """F S_v with S_v = lambda_v tr(dE/dt) I + 2 mu_v dE/dt."""
    f, rate = F.reshape(2, 2), RATE.reshape(2, 2)
    strain_rate = 0.5 * (f.T @ rate + rate.T @ f)
    expected = f @ (VISCOUS_LAME * np.trace(strain_rate) * np.eye(2) + 2 * VISCOUS_SHEAR * strain_rate)
    found = _stress(F, RATE, _arguments(True, False)) - _stress(F, RATE, _arguments(False, False))
    assert found == pytest.approx(expected.ravel(), rel=1e-10)


@pytest.mark.parametrize("plane_stress", [False, True])
def test_moduli_are_the_derivatives_of_the_stress(plane_stress):
    """By F and by its rate, with damping, fibres, branches and their history."""
    arguments = _arguments(True, plane_stress, (300.0, -200.0, 100.0), (5e3, 4e4))
    elastic, viscous = np.empty((1, 1, 4, 4, 1)), np.empty((1, 1, 4, 4, 1))
    constitutive.moduli(_point(F), _point(RATE), *arguments, elastic, viscous, ONE)
    by_deformation = _difference(lambda f: _stress(f, RATE, arguments), F)
    by_rate = _difference(lambda r: _stress(F, r, arguments), RATE)
    assert elastic[0, 0, ..., 0] == pytest.approx(by_deformation, rel=1e-6, abs=1e-3)
    assert viscous[0, 0, ..., 0] == pytest.approx(by_rate, rel=1e-6, abs=1e-3)


@pytest.mark.parametrize("plane", ["strain", "stress"])
def test_a_pulled_bar_has_the_stiffness_and_contraction_of_theory(plane, rectangle, equilibrium_of):
    """Hanging straight down: E and nu in plane stress, E / (1 - nu^2) and nu / (1 - nu) in plane strain."""
    modulus, ratio, length, height, gravity = 1e5, 0.45, 0.1, 0.005, 0.1
    model = rectangle(length, height, True, modulus, ratio, plane=plane)
    materials = model.description.material.model_copy(update={"gravity_m_per_s2": (gravity, 0.0)})
    model = type(model)(model.description.model_copy(update={"material": materials}))
    displacement, mesh = equilibrium_of(model)
    x = mesh.nodes[:, 0]
    stiffness = modulus if plane == "stress" else modulus / (1 - ratio**2)
    narrowing = ratio if plane == "stress" else ratio / (1 - ratio)
    middle, tip = np.abs(x - length / 2) < 1e-9, x > length - 1e-9
    stretch = displacement[tip, 0].mean() - displacement[middle, 0].mean()
    assert stretch == pytest.approx(1000 * gravity * length**2 / (8 * stiffness), rel=0.005)
    strain = 1000 * gravity * (length / 2) / stiffness
    assert np.ptp(displacement[middle, 1]) == pytest.approx(narrowing * strain * height, rel=0.005)


def test_green_stress_and_its_direction_agree():
    """The directional derivative of C : E against central differences."""
    shear, lame = np.array([[SHEAR]]), np.array([[LAME]])

    def value(f):
        out = np.empty((1, 1, 3, 1))
        constitutive.green_stress(_point(f), shear, lame, out, ONE)
        return out[0, 0, :, 0]

    out = np.empty((1, 1, 3, 1))
    constitutive.green_stress_direction(_point(F), _point(RATE), shear, lame, out, ONE)
    expected = (value(F + STEP * RATE) - value(F - STEP * RATE)) / (2 * STEP)
    assert out[0, 0, :, 0] == pytest.approx(expected, rel=1e-7)


def test_a_branch_relaxes_as_maxwell_says():
    """A strain held after a ramp leaves g C : E phi(ramp / tau) exp(-t / tau), whatever the steps."""
    branches = Branches([(0.5, 0.2)])
    strain = np.array([1.0, -0.4, 0.2])[None, None, :, None]
    stress = np.zeros((1, 1, 1, 3, 1))
    for step in range(4):
        stress = branches.advance(stress, strain * step / 4, strain * (step + 1) / 4, 0.025)
    for _ in range(3):
        stress = branches.advance(stress, strain, strain, 0.1)
    expected = 0.5 * (1 - np.exp(-0.5)) / 0.5 * np.exp(-0.3 / 0.2) * strain
    assert stress[0] == pytest.approx(expected, rel=1e-12)
