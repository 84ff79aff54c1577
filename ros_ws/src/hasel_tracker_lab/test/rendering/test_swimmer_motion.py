# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from hasel_tracker.tracking.marker_set import bending_angle
from hasel_tracker_lab.rendering.swimmer_motion import (
    BendingMotion,
    BodyShape,
    SampledMotion,
    line_through_markers,
    points_at,
)

SHAPE = BodyShape()


def test_body_keeps_its_length():
    """However much it bends, the centre line stays 190 mm long."""
    motion = BendingMotion()
    for bend in (-1.5, 0.0, 0.7):
        steps = np.diff(motion.line_when_bent(bend), axis=0)
        assert np.hypot(*steps.T).sum() == pytest.approx(0.190, rel=1e-9)


def test_small_bend_gives_the_angle_of_a_circular_arc():
    """For a small bend the markers' angle is that of straight – arc – straight, worked out by hand."""
    bend = 0.02
    start, end = SHAPE.muscle_stations_m
    head, middle, tail = SHAPE.marker_stations_m
    curvature = bend / (end - start)
    height_middle = 0.5 * curvature * (middle - start) ** 2
    height_tail = bend * (tail - end) + 0.5 * curvature * (end - start) ** 2
    expected = (height_tail - height_middle) / (tail - middle) - height_middle / (middle - head)
    markers = BendingMotion().markers_when_bent(bend)
    assert bending_angle(markers * [1.0, -1.0])[0] == pytest.approx(expected, rel=2e-3)


def test_rests_then_beats_at_its_frequency():
    """Nothing moves during the rest; afterwards the bend comes back after one period."""
    motion = BendingMotion(0.5, 2.0, 2.0, rest_s=0.3)
    assert motion.bend(0.29) == 0.0
    assert motion.bend(1.4) == pytest.approx(motion.bend(0.9))
    assert motion.bend(0.3 + 0.625) == pytest.approx(0.5)


def test_line_through_markers_passes_through_them():
    """The smooth line has the three markers at their stations."""
    markers = np.array([[0.0, 0.0], [0.088, 0.01], [0.17, -0.02]])
    line = line_through_markers(markers, SHAPE)
    found = points_at(line, np.array(SHAPE.marker_stations_m), SHAPE.total_length_m)
    assert np.abs(found - markers).max() < 1e-6


def test_sampled_motion_is_linear_in_between():
    """Half way between two samples the line is half way too, and it stays at the last one after the end."""
    lines = np.array([np.zeros((5, 2)), np.ones((5, 2))])
    motion = SampledMotion(np.array([2.0, 4.0]), lines)
    assert motion.duration_s == 2.0
    assert motion.centre_line(1.0) == pytest.approx(0.5 * np.ones((5, 2)))
    assert motion.centre_line(9.0) == pytest.approx(np.ones((5, 2)))
