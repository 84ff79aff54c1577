# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Current limit."""

import numpy as np
import pytest


def test_the_rise_takes_time_in_proportion_to_the_voltage(response):
    """At 50 kV/s, 3.5 kV are reached after 70 ms and 5.5 kV after 110 ms, and both fall at the same rate."""
    time = np.array([0.0, 0.0, 0.07, 0.11, 0.3, 0.3, 0.35])
    on = np.array([0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0])
    found = response("current_limit", time, on[:, None] * np.array([3500.0, 5500.0]), inverse_rate=2e-5)
    assert found[:, 0] == pytest.approx([0.0, 0.0, 3500.0, 3500.0, 3500.0, 3500.0, 1000.0])
    assert found[:, 1] == pytest.approx([0.0, 0.0, 3500.0, 5500.0, 5500.0, 5500.0, 3000.0])


def test_a_reversed_polarity_takes_twice_as_long(response):
    """From +V to -V the supply moves 2 V at its rate."""
    time = np.array([0.0, 0.0, 1.0, 1.0, 1.1, 1.2])
    command = np.array([0.0, 5e3, 5e3, -5e3, -5e3, -5e3])[:, None] * np.ones(2)
    found = response("current_limit", time, command, inverse_rate=2e-5)[:, 0]
    assert found[-2:] == pytest.approx([0.0, -5e3], abs=1e-6)
