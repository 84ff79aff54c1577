# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A camera's lens as ROS says it: `sensor_msgs/CameraInfo` of the full picture or of one drawn smaller.

image_transport looks for it beside the picture's topic.
"""

import numpy as np
from sensor_msgs.msg import CameraInfo
from std_msgs.msg import Header

from hasel_tracker.calibration.camera_calibration import CameraCalibration

MODEL = "plumb_bob"
"""OpenCV's five coefficients, by the name that image_geometry knows."""


def camera_info(
    calibration: CameraCalibration | None, size_px: tuple[int, int], header: Header
) -> CameraInfo:
    """What is known of the lens of a picture of this size [px], wide and high.

    A lens that was not calibrated is zeros, which is how the message says so. Pixels are counted at their centres, as
    OpenCV does, so that a smaller picture's principal point moves by half a pixel less.
    """
    message = CameraInfo(header=header, width=size_px[0], height=size_px[1])
    if calibration is None or not calibration.has_lens:
        return message
    scale = np.divide(size_px, calibration.image_size_px)
    matrix = np.array(calibration.camera_matrix, float)
    matrix[:2, 2] += 0.5
    matrix[:2] *= scale[:, None]
    matrix[:2, 2] -= 0.5
    message.distortion_model, message.d = MODEL, calibration.distortion.tolist()
    message.k = matrix.ravel()
    message.r = np.eye(3).ravel()
    message.p = np.column_stack([matrix, np.zeros(3)]).ravel()
    return message
