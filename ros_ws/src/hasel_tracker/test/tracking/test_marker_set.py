# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from hasel_recording import sin_theta_from_markers
from hasel_tracker.tracking.marker_set import bending_angle
from hypothesis import given
from hypothesis import strategies as st


@pytest.mark.parametrize("degrees", [-120.0, -30.0, 0.0, 45.0, 90.0])
def test_angle_of_a_known_bend(degrees):
    """The tail turned by an angle towards the top of the picture gives that angle and its sine."""
    angle = np.radians(degrees)
    points = np.array([[0.0, 0.0], [10.0, 0.0], [10.0 + 7.0 * np.cos(angle), -7.0 * np.sin(angle)]])
    sin_theta, theta = bending_angle(points)
    assert sin_theta == pytest.approx(np.sin(angle))
    assert theta == pytest.approx(angle)


def test_mirrored_camera_changes_the_sign():
    """A camera from below sees the body bend the other way."""
    points = np.array([[0.0, 0.0], [10.0, 0.0], [18.0, -3.0]])
    assert bending_angle(points, mirrored=True) == pytest.approx([-value for value in bending_angle(points)])


@given(turn=st.floats(-3.0, 3.0), scale=st.floats(0.01, 100.0), bend=st.floats(-1.5, 1.5))
def test_angle_does_not_depend_on_where_the_camera_is(turn, scale, bend):
    """Turning, moving and scaling the picture leaves sin θ as it is, and the recordings' formula agrees."""
    points = np.array([[-5.0, 0.0], [0.0, 0.0], [6.0 * np.cos(bend), -6.0 * np.sin(bend)]])
    cosine, sine = np.cos(turn), np.sin(turn)
    moved = scale * points @ np.array([[cosine, -sine], [sine, cosine]]) + [300.0, 200.0]
    sin_theta, _ = bending_angle(moved)
    assert sin_theta == pytest.approx(np.sin(bend), abs=1e-6)
    assert sin_theta == pytest.approx(sin_theta_from_markers(moved[None] * [1.0, -1.0])[0])


def test_no_angle_without_three_markers():
    """A lost marker, or two in one place, gives NaN."""
    assert np.isnan(bending_angle(np.array([[0.0, 0.0], [np.nan, np.nan], [2.0, 0.0]]))).all()
    assert np.isnan(bending_angle(np.array([[1.0, 1.0], [1.0, 1.0], [2.0, 0.0]]))).all()
