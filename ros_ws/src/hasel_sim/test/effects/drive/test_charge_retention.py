# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Charge retention."""

import numpy as np
import pytest


def _held(times, value=5e3):
    time = np.concatenate([[0.0], times])
    return time, np.concatenate([[0.0], np.full(len(times), value)])[:, None] * np.ones(2)


def test_a_held_voltage_sags_to_its_unshielded_part(response):
    """A step loses beta (1 - 1/e) of itself after one retention time, and beta in the end."""
    time, command = _held(np.array([0.0, 3.0, 300.0]))
    found = response("charge_retention", time, command, fraction=0.3, time=3.0)[:, 0]
    assert found[1:] == pytest.approx([5e3, 5e3 * (1 - 0.3 * (1 - np.exp(-1))), 5e3 * 0.7])


def test_what_is_retained_outlives_the_voltage(response):
    """Right after switching off, the shield remains with the opposite sign."""
    time = np.array([0.0, 0.0, 300.0, 300.0])
    command = np.array([0.0, 5e3, 5e3, 0.0])[:, None] * np.ones(2)
    found = response("charge_retention", time, command, fraction=0.3, time=3.0)
    assert found[-1] == pytest.approx(-0.3 * 5e3)


def test_reversing_the_polarity_every_cycle_removes_it(response):
    """With alternating polarity much faster than the retention time, no charge collects."""
    time = np.repeat(np.arange(0.0, 20.0, 0.05), 2)[1:]
    sign = np.where(np.arange(len(time)) % 4 < 2, 1.0, -1.0)
    plain = response("charge_retention", time, 5e3 * np.ones((len(time), 2)), fraction=0.3, time=3.0)
    alternating = response("charge_retention", time, 5e3 * sign[:, None] * np.ones(2), fraction=0.3, time=3.0)
    assert np.abs(plain[-1, 0]) == pytest.approx(0.7 * 5e3, rel=1e-2)
    assert np.abs(np.abs(alternating[-100:]) - 5e3).max() < 0.01 * 5e3
