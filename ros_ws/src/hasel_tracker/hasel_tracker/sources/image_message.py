"""ROS image messages as BGR images."""

from typing import Any

import cv2
import numpy as np

from hasel_tracker.errors import TrackerError

TO_BGR = {
    "bgr8": None,
    "rgb8": cv2.COLOR_RGB2BGR,
    "bgra8": cv2.COLOR_BGRA2BGR,
    "rgba8": cv2.COLOR_RGBA2BGR,
    "bayer_rggb8": cv2.COLOR_BayerBG2BGR,
    "bayer_bggr8": cv2.COLOR_BayerRG2BGR,
    "bayer_gbrg8": cv2.COLOR_BayerGR2BGR,
    "bayer_grbg8": cv2.COLOR_BayerGB2BGR,
    "yuv422_yuy2": cv2.COLOR_YUV2BGR_YUY2,
    "uyvy": cv2.COLOR_YUV2BGR_UYVY,
}
CHANNELS = {"bgr8": 3, "rgb8": 3, "bgra8": 4, "rgba8": 4, "yuv422_yuy2": 2, "uyvy": 2}


def image_of(message: Any) -> np.ndarray:
    """8-bit BGR image, shape (height, width, 3), of a sensor_msgs Image or CompressedImage."""
    return _compressed(message) if hasattr(message, "format") else _raw(message)


def _raw(message: Any) -> np.ndarray:
    if message.encoding not in TO_BGR:
        raise TrackerError(
            f"The image topic sends '{message.encoding}'; expected a colour image: {', '.join(TO_BGR)}."
        )
    channels = CHANNELS.get(message.encoding, 1)
    data = np.frombuffer(message.data, np.uint8)
    if message.step < message.width * channels or data.size < message.step * message.height:
        raise TrackerError(
            f"The image topic sends {data.size} bytes for {message.width} × {message.height} px "
            f"'{message.encoding}'; check the camera driver."
        )
    rows = data[: message.step * message.height].reshape(message.height, message.step)
    pixels = rows[:, : message.width * channels]
    pixels = pixels if channels == 1 else pixels.reshape(message.height, message.width, channels)
    conversion = TO_BGR[message.encoding]
    return np.ascontiguousarray(pixels) if conversion is None else cv2.cvtColor(pixels, conversion)


def _compressed(message: Any) -> np.ndarray:
    image = cv2.imdecode(np.frombuffer(message.data, np.uint8), cv2.IMREAD_COLOR)
    if image is None:
        raise TrackerError(
            f"The image topic sends '{message.format}' that cannot be decoded; expected JPEG or PNG."
        )
    return image
