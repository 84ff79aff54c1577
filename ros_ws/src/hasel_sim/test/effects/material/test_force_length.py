# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Force-length weakening."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.effects.base import MaterialPoints
from hasel_sim.effects.registry import catalogue
from hasel_sim.run import Run
from hasel_sim.simulate import simulate


def test_a_fibre_5_per_cent_short_pulls_a_quarter_less():
    """With k = 0.5 and eps_0 = 0.1, a shortening of 5 % takes 25 % of the fibre's tension, in any direction."""
    shortening, contraction, angle = 0.05, 0.08, 0.3
    fibre = (1 - shortening) * np.array([np.cos(angle), np.sin(angle)])
    deformation = np.stack([fibre, [-np.sin(angle), np.cos(angle)]], axis=1)[None]
    at = MaterialPoints(deformation, 0 * deformation, np.array([contraction]), np.zeros(1), 65e3, 0.0)
    stress = catalogue()["force_length"].first_piola(at, SimpleNamespace(weakening=0.5))[0]
    tension = 65e3 * ((1 - shortening) - (1 - contraction))
    assert stress[:, 0] == pytest.approx(-0.25 * tension * fibre / (1 - shortening))
    assert not stress[:, 1].any()


def test_a_held_body_bends_less_the_more_it_contracts(coarse_swimmer):
    """The loss of bending grows faster than in proportion to the contraction."""
    loss = []
    for level in (3500.0, 5500.0):
        run = Run("held", np.array([0.0, 1.5]), DriveSchedule(np.zeros(1), np.array([[level, 0.0]])))
        plain = simulate(coarse_swimmer, run).markers[-1]
        model = coarse_swimmer.with_effects("force_length").with_values({"force_length.weakening": 1.0})
        weak = simulate(model, run).markers[-1]
        bend = [_bend(markers) for markers in (plain, weak)]
        loss.append(1 - bend[1] / bend[0])
    assert loss[0] > 0.02
    assert loss[1] / loss[0] == pytest.approx(0.0624 / 0.0268, rel=0.3)


def _bend(markers: np.ndarray) -> float:
    first, second = markers[1] - markers[0], markers[2] - markers[1]
    return float(np.arctan2(second[1], second[0]) - np.arctan2(first[1], first[0]))
