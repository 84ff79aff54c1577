# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Surface friction."""

import numpy as np
import pytest
from scipy.constants import g


def test_the_envelope_falls_linearly(cantilever, extremes):
    """Coulomb: every half cycle loses 2 F / k, whatever the amplitude, as long as the beam is far from sticking."""
    beam, coefficient = cantilever(), 0.01
    _, tip = beam.ring_down(1.3, "surface_friction", coefficient=coefficient, tip=0.02)
    loss = -np.diff(extremes(tip)[:6])
    omega_squared = beam.frequency**2
    shape = beam.along(lambda mode: mode) / beam.along(lambda mode: mode**2)
    assert np.std(loss) < 0.06 * np.mean(loss)
    assert np.mean(loss) == pytest.approx(2 * coefficient * g * shape / omega_squared, rel=0.08)
