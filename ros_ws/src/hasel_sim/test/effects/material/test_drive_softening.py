# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Drive softening."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.effects.base import MaterialPoints
from hasel_sim.effects.registry import catalogue


def test_the_shear_modulus_falls_with_the_contraction():
    """What is lost is s tanh(a) of the neo-Hookean shear stress, nothing in a muscle at rest."""
    deformation = np.eye(2) + 0.1 * np.random.default_rng(0).standard_normal((2, 2, 2))
    contraction = np.array([0.0, 0.3])
    zero = np.zeros(2)
    at = MaterialPoints(deformation, 0 * deformation, contraction, zero, zero, 0.0, np.full(2, 2e4))
    found = catalogue()["drive_softening"].first_piola(at, SimpleNamespace(softening=0.5))
    inverse = np.linalg.inv(deformation).transpose(0, 2, 1)
    expected = -0.5 * np.tanh(contraction)[:, None, None] * 2e4 * (deformation - inverse)
    assert found == pytest.approx(expected)


def test_a_held_body_bends_more_where_it_softens(coarse_swimmer, sin_theta_of):
    """Softer walls yield more to the same muscle."""
    soft = coarse_swimmer.with_effects("drive_softening").with_values({"drive_softening.softening": 0.9})
    assert np.abs(sin_theta_of(soft)).max() > np.abs(sin_theta_of(coarse_swimmer)).max()
