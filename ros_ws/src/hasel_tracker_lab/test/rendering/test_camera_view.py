import cv2
import numpy as np
import pytest
from hasel_tracker_lab.rendering.camera_view import CameraView

POINTS = np.random.default_rng(2).uniform(-0.09, 0.09, (40, 2))
VIEWS = [
    CameraView(),
    CameraView(tilt_rad=0.3, roll_rad=0.5),
    CameraView(tilt_rad=-0.2, pan_rad=0.25, radial_distortion=-0.15),
]


@pytest.mark.parametrize("view", VIEWS)
def test_projection_agrees_with_opencv(view):
    """Plane points land where OpenCV's pinhole camera with that pose and lens puts them."""
    axis, _ = cv2.Rodrigues(np.array([0.0, 0.0, view.roll_rad]))
    tilt, _ = cv2.Rodrigues(np.array([view.tilt_rad, 0.0, 0.0]))
    pan, _ = cv2.Rodrigues(np.array([0.0, view.pan_rad, 0.0]))
    rotation, _ = cv2.Rodrigues(pan @ tilt @ axis @ np.diag([1.0, -1.0, -1.0]))
    spatial = np.column_stack([POINTS, np.zeros(len(POINTS))])
    position = np.array([0.0, 0.0, view.distance_m])
    expected, _ = cv2.projectPoints(spatial, rotation, position, view.camera_matrix, view.distortion)
    assert np.abs(view.to_pixels(POINTS) - expected.reshape(-1, 2)).max() < 1e-6


@pytest.mark.parametrize("view", VIEWS)
def test_back_to_the_plane(view):
    """From the image back to the plane, each point returns to within a micrometre."""
    assert np.abs(view.to_plane(view.to_pixels(POINTS)) - POINTS).max() < 1e-6


def test_up_in_the_plane_is_up_in_the_picture():
    """The plane's y points to the top of the picture, x to its right."""
    origin, right, up = CameraView().to_pixels(np.array([[0.0, 0.0], [0.01, 0.0], [0.0, 0.01]]))
    assert (right - origin) == pytest.approx([60.0, 0.0])
    assert (up - origin) == pytest.approx([0.0, -60.0])
