"""Added mass of a body of finite depth."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_sim.effects.base import Surroundings
from hasel_sim.effects.slender import finite_length_factor
from hasel_sim.model.medium import FLUIDS
from scipy.special import ellipe


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
