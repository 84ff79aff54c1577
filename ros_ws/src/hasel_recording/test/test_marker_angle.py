from pathlib import Path

import numpy as np
import pytest
from hasel_recording import read_recording, sin_theta_from_markers
from hasel_recording.marker_angle import turn_between

REAL_BEAM = Path(__file__).resolve().parents[4].parent / "shared" / "data" / "real_beam"


@pytest.mark.parametrize("degrees", [-170, -90, -30, 0, 30, 90, 150])
def test_angle_between_two_segments(degrees):
    """Two segments of any lengths, position and orientation give the sine of the angle between them."""
    angle, heading = np.deg2rad(degrees), 0.7
    head = np.array([3.0, -2.0])
    middle = head + 0.05 * np.array([np.cos(heading), np.sin(heading)])
    tail = middle + 0.09 * np.array([np.cos(heading + angle), np.sin(heading + angle)])
    assert sin_theta_from_markers(np.array([[head, middle, tail]])) == pytest.approx(
        [np.sin(angle)], abs=1e-12
    )


def test_any_number_of_axes_comes_before():
    """One frame, frames of a run, or runs of frames."""
    markers = np.random.default_rng(0).normal(size=(4, 5, 3, 2))
    found = sin_theta_from_markers(markers)
    assert found.shape == (4, 5)
    assert found[2].tolist() == sin_theta_from_markers(markers[2]).tolist()
    assert found[2, 3] == sin_theta_from_markers(markers[2, 3])


@pytest.mark.parametrize("degrees", [-170, -90, 0, 30, 150])
def test_turn_tells_which_way_round(degrees):
    """The angle beyond a right one too, which its sine alone does not tell."""
    angle = np.deg2rad(degrees)
    sine, turn = turn_between(np.array([2.0, 0.0]), 0.5 * np.array([np.cos(angle), np.sin(angle)]))
    assert (sine, turn) == (pytest.approx(np.sin(angle)), pytest.approx(angle))


def test_coinciding_markers_have_no_angle():
    """A marker on top of another one gives NaN in that frame only."""
    frames = np.array([[[0, 0], [0, 0], [1, 0]], [[0, 0], [1, 0], [2, 0]]], dtype=float)
    assert np.isnan(sin_theta_from_markers(frames)).tolist() == [True, False]


@pytest.mark.skipif(not REAL_BEAM.is_dir(), reason="the measured beam's files are not beside the repository")
def test_measured_beam():
    """On the measured beam the markers give the angle that its authors computed from them."""
    recording = read_recording(REAL_BEAM / "gravity_a.csv")
    assert sin_theta_from_markers(recording.markers) == pytest.approx(recording.sin_theta, abs=2e-7)
