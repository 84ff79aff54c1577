# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Spine stiffening."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.effects.base import MaterialPoints
from hasel_sim.effects.registry import catalogue
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

STIFFENING = 3e8


def _stress(deformation: np.ndarray) -> np.ndarray:
    at = MaterialPoints(
        deformation, 0 * deformation, np.zeros(len(deformation)), np.zeros(len(deformation)), 0.0, 0.0
    )
    return catalogue()["spine_stiffening"].first_piola(at, SimpleNamespace(stiffening=STIFFENING))


def _energy(deformation: np.ndarray) -> np.ndarray:
    strain = 0.5 * (np.sum(deformation[:, :, 0] ** 2, axis=1) - 1)
    return STIFFENING * strain**4


def test_the_stress_is_the_derivative_of_the_energy(derivative):
    """First Piola stress = dW/dF of W = k E_xx^4, at random deformations."""
    deformation = np.eye(2) + 0.05 * np.random.default_rng(0).standard_normal((5, 2, 2))
    stress = _stress(deformation)
    assert stress == pytest.approx(derivative(_energy, deformation), abs=1e-6 * np.abs(stress).max())


def test_eight_times_the_stress_at_twice_the_strain():
    """The additional stress is cubic in the Green strain and turns with the material."""
    strains = np.array([0.004, 0.008])
    deformation = np.eye(2) * np.stack([np.sqrt(1 + 2 * strains), np.ones(2)], axis=1)[:, None, :]
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    second = np.linalg.solve(deformation, _stress(deformation))[:, 0, 0]
    assert second == pytest.approx(4 * STIFFENING * strains**3)
    assert _stress(turn @ deformation) == pytest.approx(turn @ _stress(deformation))


def test_the_body_bends_less(coarse_swimmer):
    """Held at 5.5 kV, a body with a stiffening spine comes to rest less bent."""
    run = Run("held", np.array([0.0, 2.0]), DriveSchedule(np.zeros(1), np.array([[5500.0, 0.0]])))
    model = coarse_swimmer.with_effects("spine_stiffening").with_values({"spine_stiffening.stiffening": 1e9})
    plain, stiffer = (simulate(m, run).sin_theta[-1] for m in (coarse_swimmer, model))
    assert 0 < stiffer < 0.98 * plain
