# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Marker offset."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.effects.registry import catalogue
from hasel_sim.run import Run
from hasel_sim.simulate import simulate


def test_a_straight_body_seems_bent(coarse_swimmer):
    """At rest the two chords through a marker d off the line turn by atan(d/a) + atan(d/b) away from it."""
    first, second, offset = 0.094 - 0.005, 0.190 - 0.094, 0.002
    model = coarse_swimmer.with_effects("marker_offset").with_values({"marker_offset.offset": offset})
    found = simulate(model, Run("rest", np.linspace(0.0, 0.1, 5))).sin_theta
    assert found == pytest.approx(-np.sin(np.arctan(offset / first) + np.arctan(offset / second)), rel=1e-6)


def test_the_marker_turns_with_the_body():
    """On a body bent by 90 degrees a middle marker is moved along the old x axis."""
    positions = np.zeros((1, 3, 2))
    across = np.tile([-1.0, 0.0], (1, 3, 1))
    seen = catalogue()["marker_offset"].markers(positions, across, SimpleNamespace(offset=0.003))
    assert seen[0].tolist() == [[0.0, 0.0], [-0.003, 0.0], [0.0, 0.0]]
