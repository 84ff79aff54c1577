# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Drive hysteresis."""

import numpy as np
import pytest


def _loop_area(response, period, width):
    time = np.linspace(0.0, 3 * period, 6001)
    voltage = 5e3 * np.abs(((2 * time / period + 1) % 2) - 1)
    found = response("drive_hysteresis", time, voltage[:, None] * np.ones(2), width=width)[:, 0]
    last = time >= 2 * period
    u, y = voltage[last], found[last]
    return abs(np.sum(0.5 * (y[1:] + y[:-1]) * np.diff(u)))


def test_the_loop_is_that_of_a_play_whatever_the_rate(response):
    """Between 0 and U a play of half-width w encloses 2 w (U - 2 w), at any frequency."""
    exact = 2 * 400.0 * (5e3 - 2 * 400.0)
    assert _loop_area(response, 2.0, 400.0) == pytest.approx(exact, rel=1e-3)
    assert _loop_area(response, 0.05, 400.0) == pytest.approx(exact, rel=1e-3)


def test_release_lags_zipping(response):
    """Half the width is missing when the voltage comes and remains when it goes."""
    time = np.array([0.0, 0.0, 1.0, 1.0, 2.0])
    command = np.array([0.0, 5e3, 5e3, 0.0, 0.0])[:, None] * np.array([1.0, -1.0])
    found = response("drive_hysteresis", time, command, width=600.0)
    assert np.abs(found[:, 0]) == pytest.approx([0.0, 4400.0, 4400.0, 600.0, 600.0])
    assert np.abs(found[:, 1]) == pytest.approx(np.abs(found[:, 0]))
