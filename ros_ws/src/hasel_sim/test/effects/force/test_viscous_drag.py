# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Viscous drag."""

import numpy as np
import pytest
from hasel_sim.model.sections import FLUIDS

DEPTH = 0.05


def test_a_ring_down_is_exponential_at_the_rate_of_its_resistance(cantilever, damped_sine):
    """Damping ratio = mu K_n / (2 H m omega), m the beam's mass per length and depth."""
    beam, across = cantilever(), 40.0
    time, tip = beam.ring_down(2.0, "viscous_drag", across=across)
    found, damping = damped_sine(time, tip, beam.frequency)
    rate = FLUIDS["canola_oil"][1] * across / DEPTH / (beam.density * beam.height)
    assert damping == pytest.approx(rate / (2 * found), rel=0.02)
    assert np.abs(tip).max() == pytest.approx(tip[0])
