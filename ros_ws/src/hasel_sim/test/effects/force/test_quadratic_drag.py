# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Quadratic drag."""

import numpy as np
import pytest
from hasel_sim.effects.force.quadratic_drag import FLUID_DENSITY


def test_the_inverse_amplitude_grows_linearly(cantilever, extremes):
    """Energy lost per cycle goes with amplitude cubed, so 1/amplitude grows by (8/3) b / m each cycle."""
    beam, coefficient = cantilever(), 2.0
    _, tip = beam.ring_down(2.0, "quadratic_drag", coefficient=coefficient, tip=0.008)
    found = 1 / extremes(tip)
    growth = np.diff(found)
    mass = beam.density * beam.height * beam.along(lambda mode: mode**2)
    drag = 2 * 0.5 * FLUID_DENSITY * coefficient * beam.along(lambda mode: np.abs(mode) ** 3)
    assert np.mean(growth) == pytest.approx(4 / 3 * drag / mass, rel=0.05)
    assert np.std(growth) < 0.1 * np.mean(growth)
