# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Pre-bend."""

import numpy as np
import pytest
from hasel_sim.effects.registry import catalogue
from hasel_sim.run import Run
from hasel_sim.simulate import simulate


def test_a_free_body_rests_on_a_circle(rectangle):
    """With rest curvature kappa the two half chords turn by kappa L / 2, towards y, and nothing moves."""
    length, curvature = 0.1, 1.5
    model = rectangle(
        length, 0.01, False, effects=(catalogue()["pre_bend"],), values={"pre_bend.curvature": curvature}
    )
    found = simulate(model, Run("rest", np.linspace(0.0, 0.2, 5))).sin_theta
    assert found == pytest.approx(np.sin(curvature * length / 2), rel=2e-3)
    assert np.ptp(found) < 1e-6
