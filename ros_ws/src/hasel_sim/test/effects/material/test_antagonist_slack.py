# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Antagonist slack."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.effects.base import MaterialPoints
from hasel_sim.effects.registry import catalogue
from hasel_sim.run import Run
from hasel_sim.simulate import simulate


def test_the_film_is_slack_and_then_taut():
    """Tension is zero up to the slack strain and grows with the film's stiffness beyond it."""
    stretch = np.array([0.97, 1.005, 1.01, 1.03])
    deformation = np.eye(2) * np.stack([stretch, np.ones(4)], axis=1)[:, None, :]
    at = MaterialPoints(deformation, 0 * deformation, np.zeros(4), np.zeros(4), 65e3, 0.0)
    p = SimpleNamespace(stiffness=2e5, slack_strain=0.01)
    stress = catalogue()["antagonist_slack"].first_piola(at, p)
    assert stress[:, 0, 0] == pytest.approx([0.0, 0.0, 0.0, 2e5 * 0.02], abs=1e-6)
    assert not stress[:, 1].any() and not stress[:, :, 1].any()


def test_high_voltages_are_clipped_and_low_ones_are_not(coarse_swimmer):
    """With a slack that 3.5 kV does not use up, only 5.5 kV bends the body less."""
    model = coarse_swimmer.with_effects("antagonist_slack")
    model = model.with_values({"antagonist_slack.stiffness": 2e5, "antagonist_slack.slack_strain": 0.008})
    change = []
    for level in (3500.0, 5500.0):
        run = Run("held", np.arange(0, 0.5, 1 / 60), DriveSchedule(np.zeros(1), np.array([[level, 0.0]])))
        change.append(np.abs(simulate(model, run).sin_theta - simulate(coarse_swimmer, run).sin_theta).max())
    assert change[0] < 1e-9
    assert change[1] > 1e-3
