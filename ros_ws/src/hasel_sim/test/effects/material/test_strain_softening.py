# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Strain softening."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.effects.base import MaterialPoints
from hasel_sim.effects.registry import catalogue
from hasel_sim.errors import SimulationError
from hasel_sim.model import load_model
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

SHEAR, SOFTENING, STRAIN = 2e4, 0.4, 0.1


def _stress(deformation: np.ndarray) -> np.ndarray:
    zero = np.zeros(len(deformation))
    at = MaterialPoints(deformation, 0 * deformation, zero, zero, zero, 0.0, SHEAR)
    return catalogue()["strain_softening"].first_piola(
        at, SimpleNamespace(softening=SOFTENING, reference_strain=STRAIN)
    )


def _energy(deformation: np.ndarray) -> np.ndarray:
    volume = np.linalg.det(deformation)
    excess = np.sum(deformation**2, axis=(1, 2)) - 2.0 - 2.0 * np.log(volume)
    scale = 2 * STRAIN**2
    return -0.5 * SOFTENING * SHEAR * (excess - scale * np.log1p(excess / scale))


def test_the_stress_is_the_derivative_of_the_energy(derivative):
    """First Piola stress = dW/dF, at random deformations."""
    deformation = np.eye(2) + 0.1 * np.random.default_rng(0).standard_normal((5, 2, 2))
    stress = _stress(deformation)
    assert stress == pytest.approx(derivative(_energy, deformation), abs=1e-6 * np.abs(stress).max())


def test_small_strains_meet_the_whole_modulus_and_large_ones_what_is_left():
    """In simple shear, the stress lost over mu gamma grows from 0 to d, and is half of it near eps_0 sqrt 2."""
    shear = np.array([1e-3, STRAIN * np.sqrt(2), 10.0])
    deformation = np.tile(np.eye(2), (3, 1, 1))
    deformation[:, 0, 1] = shear
    lost = -_stress(deformation)[:, 0, 1] / (SHEAR * shear)
    assert lost == pytest.approx([0.0, 0.5 * SOFTENING, SOFTENING], abs=2e-3)


def test_it_leaves_no_body_softer_than_a_wrong_constant_may():
    """Past its reference strain it is one; with a wider range it would stand for constants beyond theirs."""
    softening, scale = (catalogue()[effect].parameters[0] for effect in ("strain_softening", "soft_modulus"))
    assert 1 - softening.upper == pytest.approx(scale.lower)


@pytest.mark.filterwarnings("error")
def test_a_body_that_would_be_turned_inside_out_is_one_sentence():
    """Its stress has no logarithm there; numpy's own warnings would not tell the user why."""
    values = {"strain_softening.softening": SOFTENING, "strain_softening.reference_strain": STRAIN}
    beam = load_model("beam").with_effects("strain_softening").with_values(values)
    undriven = DriveSchedule(np.zeros(1), np.zeros((1, 0)), ())
    loaded = {"initial_state": "static_equilibrium", "initial_load_factor": 100.0}
    with pytest.raises(SimulationError, match="no static equilibrium"):
        simulate(beam, Run("overloaded", np.arange(2) / 100, undriven, **loaded))
