# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Muscle asymmetry."""

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.run import Run
from hasel_sim.simulate import simulate


def test_the_lower_muscle_alone_is_weaker(contraction_of):
    """On the plateau the lower muscle reaches (1 - delta) times what the upper one reaches, at any voltage."""
    for level in (3500.0, 5000.0):
        schedule = DriveSchedule(np.zeros(1), np.full((1, 2), level))
        upper, lower = contraction_of(
            schedule, np.array([0.0, 2.0]), "muscle_asymmetry", gain_difference=0.2
        )[-1]
        plain = contraction_of(schedule, np.array([0.0, 2.0]))[-1]
        assert (upper, lower) == pytest.approx((plain[0], 0.8 * plain[0]))


def test_the_body_leans_to_the_stronger_side(coarse_swimmer, short_boxes):
    """With both muscles at the same voltage only the asymmetry bends the body, in proportion to it."""
    both = Run("both", short_boxes.time, DriveSchedule(np.zeros(1), np.full((1, 2), 5500.0)))
    model = coarse_swimmer.with_effects("muscle_asymmetry")
    leaning = [
        simulate(model.with_values({"muscle_asymmetry.gain_difference": value}), both).sin_theta[-1]
        for value in (0.0, 0.05, 0.1)
    ]
    assert abs(leaning[0]) < 1e-8
    assert leaning[1] > 0.005
    assert leaning[2] == pytest.approx(2 * leaning[1], rel=0.1)
