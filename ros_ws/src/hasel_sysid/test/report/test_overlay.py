# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Fewer points that look the same."""

import numpy as np
from hasel_sysid.report.overlay import decimate


def test_extremes_and_ends_stay():
    """A single-frame peak among 10 000 frames survives; no more points than asked for come out."""
    time = np.linspace(0, 10, 10_000)
    series = np.sin(time)
    series[4321] = 7.0
    few_time, few = decimate(time, series, 600)
    assert len(few_time) <= 602
    assert few.max() == 7.0
    assert (few_time[0], few_time[-1]) == (time[0], time[-1])
    assert np.all(np.diff(few_time) > 0)


def test_short_series_is_left_alone():
    """What is short enough comes back as it is."""
    time = np.arange(10.0)
    assert decimate(time, time**2)[1].tolist() == (time**2).tolist()
