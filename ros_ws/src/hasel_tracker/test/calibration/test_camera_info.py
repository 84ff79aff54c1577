# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The lens in ROS's own message: what image_geometry makes of it is where OpenCV sees a point."""

import cv2
import numpy as np
import pytest
from hasel_tracker.calibration.camera_calibration import CameraCalibration, scale_calibration
from hasel_tracker.calibration.camera_info import camera_info
from std_msgs.msg import Header

MATRIX = np.array([[1400.0, 0.0, 955.0], [0.0, 1390.0, 541.0], [0.0, 0.0, 1.0]])
DISTORTION = np.array([-0.2, 0.05, 1e-3, -5e-4, 0.0])
LENS = CameraCalibration((1920, 1080), MATRIX, DISTORTION, np.eye(3), 0.1)
POINTS = np.array([[0.1, 0.05, 1.0], [-0.3, 0.2, 1.2], [0.0, 0.0, 0.8]])


def seen(message) -> np.ndarray:
    """Where the message's lens sees the points [px], (n, 2)."""
    matrix, distortion = np.reshape(message.k, (3, 3)), np.array(message.d)
    return cv2.projectPoints(POINTS, np.zeros(3), np.zeros(3), matrix, distortion)[0].reshape(-1, 2)


@pytest.mark.parametrize("size", [(1920, 1080), (640, 360)])
def test_points_lie_where_a_picture_of_that_size_shows_them(size):
    """A smaller picture has the same points, in proportion between the outer edges of its pixels."""
    full = cv2.projectPoints(POINTS, np.zeros(3), np.zeros(3), MATRIX, DISTORTION)[0].reshape(-1, 2)
    message = camera_info(LENS, size, Header(frame_id="hasel/camera"))
    assert (message.width, message.height, message.header.frame_id) == (*size, "hasel/camera")
    assert seen(message) + 0.5 == pytest.approx((full + 0.5) * size[0] / 1920, abs=1e-9)
    assert np.reshape(message.p, (3, 4))[:, :3] == pytest.approx(np.reshape(message.k, (3, 3)))


@pytest.mark.parametrize(
    "unknown", [None, scale_calibration(np.array([0.0, 0.0]), np.array([100.0, 0.0]), 0.1, (640, 360))]
)
def test_a_lens_that_was_not_calibrated_is_zeros(unknown):
    """As the message's definition asks for."""
    assert not np.any(camera_info(unknown, (640, 360), Header()).k)
