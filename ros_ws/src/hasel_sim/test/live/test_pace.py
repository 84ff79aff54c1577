# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Real-time factor and lag."""

import math

import pytest
from hasel_sim.live.simulator_node import Pace


def test_the_report_sums_up_what_came_since_the_last():
    """Factor is time simulated over time spent; lags are mean and worst; a report starts the next."""
    pace = Pace()
    pace.add(0.010, 0.002, 0.003)
    pace.add(0.010, 0.003, 0.005)
    report = pace.report()
    assert report.messages == 2
    assert report.real_time_factor == pytest.approx(4.0)
    assert (report.mean_lag, report.worst_lag) == pytest.approx((0.004, 0.005))
    assert not report.behind
    assert pace.report().messages == 0


@pytest.mark.parametrize(("computing", "lag"), [(0.012, 0.013), (0.002, 0.5)])
def test_too_slow_or_too_late_is_behind(computing, lag):
    """Slower than time, or messages that waited long."""
    pace = Pace()
    pace.add(0.010, computing, lag)
    assert pace.report().behind


def test_messages_that_move_nothing_have_no_factor():
    """The first message of a run simulates no time."""
    pace = Pace()
    pace.add(0.0, 0.001, 0.001)
    report = pace.report()
    assert math.isnan(report.real_time_factor)
    assert not report.behind
