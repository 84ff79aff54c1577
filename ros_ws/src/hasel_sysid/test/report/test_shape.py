# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The body where it is bent most, with the measured markers."""

import numpy as np
import pytest
from hasel_recording import sin_theta_from_markers
from hasel_sim.model import load_model
from hasel_sim.parallel import executor
from hasel_sysid.comparison import compare
from hasel_sysid.dataset import load_experiments
from hasel_sysid.report.figures import shapes_figure
from hasel_sysid.report.shape import measured_tail, simulated_shapes


def test_the_measured_tail_gives_the_measured_angle():
    """At the simulated distance from the middle marker, whatever way the body lies."""
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    markers = np.array([[[0.0, 0.0], [0.05, 0.0], [0.09, 0.01]]] * 3) @ turn.T
    measured = np.array([-0.4, 0.0, 0.3])
    moved = markers.copy()
    moved[:, 2] = measured_tail(markers, measured)
    assert sin_theta_from_markers(moved) == pytest.approx(measured)
    assert np.linalg.norm(moved[:, 2] - moved[:, 1], axis=1) == pytest.approx(
        np.linalg.norm(markers[:, 2] - markers[:, 1], axis=1)
    )


def test_the_extremes_are_shown_with_both_markers(unseen_rig):
    """The most bent to either side in the first cycle, simulated and measured angle both read off the markers."""
    (experiment,) = load_experiments([unseen_rig / "quadratic_drag" / "fit_5500V_2.0Hz.csv"])
    with executor(1) as pool:
        comparison = compare(load_model("swimmer"), [experiment], pool)
    shapes = simulated_shapes(comparison.model, comparison.runs)
    series = comparison.runs[0].series
    first = series.time <= series.time[0] + series.cycle.period
    shown = sin_theta_from_markers(shapes.markers)
    assert shown.max() == pytest.approx(series.simulated[first].max(), abs=2e-3)
    assert shown.min() == pytest.approx(series.simulated[first].min(), abs=2e-3)
    at = np.searchsorted(series.time, shapes.time - 1e-6)
    assert sin_theta_from_markers(shapes.measured) == pytest.approx(
        (series.measured - series.offset)[at], abs=1e-6
    )
    assert len(shapes_figure(shapes).data) == 3 * len(shapes.time)
