# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import cv2
import numpy as np
import pytest
from hasel_tracker_lab.rendering.camera_model import CameraView, add_glints, add_noise, compress, uneven_light

POINTS = np.random.default_rng(2).uniform(-0.09, 0.09, (40, 2))
VIEWS = [
    CameraView(),
    CameraView(tilt_rad=0.3, roll_rad=0.5),
    CameraView(tilt_rad=-0.2, pan_rad=0.25, radial_distortion=-0.15),
]
GREY = np.full((240, 320, 3), 120, np.uint8)


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


def test_noise_has_its_standard_deviation_and_differs_between_frames():
    """Noise of 4 grey levels is that, has no offset, and two frames have nothing in common."""
    first, second = (add_noise(GREY, 4.0, index, 1).astype(float) - 120.0 for index in (0, 1))
    assert first.std() == pytest.approx(4.0, rel=0.03)
    assert abs(first.mean()) < 0.05
    assert abs(np.corrcoef(first.ravel(), second.ravel())[0, 1]) < 0.02


def test_light_falls_across_the_picture():
    """The far corner gets the share of light that is left."""
    picture = uneven_light(GREY.astype(np.float32), 0.6)
    assert picture[0, 0, 0] == pytest.approx(120.0, rel=0.05)
    assert picture[-1, -1, 0] == pytest.approx(0.4 * 120.0, rel=0.05)


def test_glints_are_few_and_bright():
    """Reflections brighten a small part of the picture and wander with time."""
    now, later = (add_glints(GREY.astype(np.float32), 5, time_s, 3) for time_s in (0.0, 0.5))
    assert 1e-4 < (now > 150).mean() < 0.2
    assert np.abs(now - later).max() > 10.0


def test_compression_stores_colour_at_half_resolution():
    """Through JPEG, fine stripes of colour vanish while fine stripes of brightness stay."""
    colour, luma = GREY.copy(), GREY.copy()
    colour[:, ::2] = (200, 90, 60)  # nearly the luma of (33, 111, 128)
    colour[:, 1::2] = (33, 111, 128)
    luma[:, ::2] = 180
    contrast = [np.abs(np.diff(compress(each, 95).astype(float), axis=1)).mean() for each in (colour, luma)]
    assert contrast[0] < 0.25 * contrast[1]
