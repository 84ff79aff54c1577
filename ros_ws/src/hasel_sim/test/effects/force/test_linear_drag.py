# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Linear drag."""

import pytest


def test_the_damping_ratio_is_rate_over_twice_the_frequency(cantilever, damped_sine):
    """Mass-proportional damping: zeta = c / (2 omega), and an undamped beam keeps swinging."""
    beam = cantilever()
    omega, undamped = damped_sine(*beam.ring_down(1.5), beam.frequency)
    _, zeta = damped_sine(*beam.ring_down(1.5, "linear_drag", rate=2.0), beam.frequency)
    assert abs(undamped) < 1e-3
    assert zeta - undamped == pytest.approx(2.0 / (2 * omega), rel=0.01)
