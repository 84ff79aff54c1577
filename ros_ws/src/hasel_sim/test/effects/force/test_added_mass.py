# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Added mass."""

import numpy as np
import pytest


def test_the_frequency_falls_by_the_textbook_factor(cantilever, damped_sine):
    """Fluid on both faces of a beam: omega falls by sqrt(rho h / (rho h + 2 m_a))."""
    beam, added = cantilever(height=0.01), 2.0
    plain, _ = damped_sine(*beam.ring_down(2.0), beam.frequency)
    heavier, _ = damped_sine(*beam.ring_down(2.0, "added_mass", added_mass=added), 0.85 * beam.frequency)
    own = beam.density * beam.height
    assert heavier / plain == pytest.approx(np.sqrt(own / (own + 2 * added)), rel=5e-3)
