# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Form drag."""

import numpy as np
import pytest
from hasel_sim.effects.base import Surroundings
from hasel_sim.effects.registry import find_effects
from hasel_sim.swimming.given_shape import Shape, Swimmer, swim

DENSITY, LENGTH, MASS = 998.0, 0.2, 13.5


def _straight(time: float) -> Shape:
    nothing = np.zeros((9, 2))
    place, along = nothing.copy(), nothing.copy()
    place[:, 0], along[:, 0] = np.linspace(0.0, LENGTH, 9), 1.0
    return Shape(place, nothing, nothing, along, nothing)


def test_one_over_the_speed_of_a_glide_grows_linearly():
    """m dU/dt = -1/2 rho C_t U^2 per depth and length, straight on and backwards alike."""
    lengths = np.append(np.full(8, LENGTH / 8), 0.0)
    effects = [(find_effects(("form_drag",))[0], {"coefficient": 0.3})]
    body = Swimmer(lengths, MASS * lengths, _straight, effects, Surroundings(DENSITY, 1e-3, 0.05, LENGTH))
    times = np.linspace(0.0, 3.0, 31)
    for way in (-1.0, 1.0):
        speed = way * swim(body, times, (way * 0.4, 0.0)).velocity[:, 0]
        assert 1 / speed == pytest.approx(1 / 0.4 + 0.5 * DENSITY * 0.3 / MASS * times, rel=1e-4)
