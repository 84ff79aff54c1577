# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The camera over the swimming plane: where it looks (pinhole, tilt, lens), and what it does to a clean picture."""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import cv2
import numpy as np
from hasel_tracker.errors import TrackerError

NOISE_MARGIN_PX = 64


@dataclass(frozen=True)
class CameraView:
    """A camera `distance_m` above the plane, turned about its three axes.

    The plane has x right and y up [m], origin in the middle of the picture; the image has y down [px].
    """

    width_px: int = 1920
    height_px: int = 1080
    pixels_per_m: float = 6000.0
    distance_m: float = 0.6
    tilt_rad: float = 0.0
    roll_rad: float = 0.0
    pan_rad: float = 0.0
    radial_distortion: float = 0.0

    @cached_property
    def camera_matrix(self) -> np.ndarray:
        """Pinhole matrix [px], shape (3, 3)."""
        focal = self.pixels_per_m * self.distance_m
        return np.array(
            [
                [focal, 0.0, 0.5 * (self.width_px - 1)],
                [0.0, focal, 0.5 * (self.height_px - 1)],
                [0.0, 0.0, 1.0],
            ]
        )

    @cached_property
    def distortion(self) -> np.ndarray:
        """OpenCV's five distortion coefficients."""
        return np.array([self.radial_distortion, 0.0, 0.0, 0.0, 0.0])

    @cached_property
    def plane_to_pixel(self) -> np.ndarray:
        """Homography from plane coordinates [m] to undistorted pixels, shape (3, 3)."""
        about_axis, _ = cv2.Rodrigues(np.array([0.0, 0.0, self.roll_rad]))
        tilted, _ = cv2.Rodrigues(np.array([self.tilt_rad, 0.0, 0.0]))
        panned, _ = cv2.Rodrigues(np.array([0.0, self.pan_rad, 0.0]))
        rotation = panned @ tilted @ about_axis @ np.diag([1.0, -1.0, -1.0])
        translation = np.array([0.0, 0.0, self.distance_m])
        return self.camera_matrix @ np.column_stack([rotation[:, 0], rotation[:, 1], translation])

    def to_pixels(self, points_m: np.ndarray) -> np.ndarray:
        """Image positions [px] of plane points [m], both of shape (n, 2)."""
        ideal = cv2.perspectiveTransform(np.asarray(points_m, float).reshape(1, -1, 2), self.plane_to_pixel)[
            0
        ]
        if self.radial_distortion == 0.0:
            return ideal
        rays = np.column_stack([ideal, np.ones(len(ideal))]) @ np.linalg.inv(self.camera_matrix).T
        seen, _ = cv2.projectPoints(rays, np.zeros(3), np.zeros(3), self.camera_matrix, self.distortion)
        return seen.reshape(-1, 2)

    def to_plane(self, points_px: np.ndarray) -> np.ndarray:
        """Plane points [m] seen at image positions [px], both of shape (n, 2)."""
        points = np.asarray(points_px, float).reshape(1, -1, 2)
        if self.radial_distortion != 0.0:
            points = cv2.undistortPoints(
                points, self.camera_matrix, self.distortion, P=self.camera_matrix
            ).reshape(1, -1, 2)
        return cv2.perspectiveTransform(points, np.linalg.inv(self.plane_to_pixel))[0]


@dataclass(frozen=True)
class Degradation:
    """Settings of the imaging chain; the default is a clean, slightly blurred picture.

    blur_px: standard deviation of the optics' blur. exposure_s: shutter time (motion blur). noise_levels:
    standard deviation of the sensor noise in grey levels. light_fall: relative loss of light from the
    brightest to the darkest corner. glint_count: specular reflections. jpeg_quality: 0 for none, else 1 to
    100 with 4:2:0 chroma.
    """

    blur_px: float = 0.8
    exposure_s: float = 0.0
    noise_levels: float = 0.0
    light_fall: float = 0.0
    glint_count: int = 0
    jpeg_quality: int = 0
    seed: int = 1


def uneven_light(image: np.ndarray, light_fall: float) -> np.ndarray:
    """Darken an image (float32, BGR) towards its lower right corner, with a dim patch on the left."""
    if light_fall == 0.0:
        return image
    height, width = image.shape[:2]
    return image * _light_map(height, width, light_fall)[..., None]


@lru_cache(maxsize=4)
def _light_map(height: int, width: int, light_fall: float) -> np.ndarray:
    x, y = np.meshgrid(np.linspace(0.0, 1.0, width), np.linspace(0.0, 1.0, height))
    across = 0.5 * (x + y)
    patch = 0.35 * np.exp(-(((x - 0.25) / 0.12) ** 2) - ((y - 0.5) / 0.2) ** 2)
    return (1.0 - light_fall * np.clip(across + patch, 0.0, 1.0)).astype(np.float32)


def add_glints(image: np.ndarray, count: int, time_s: float, seed: int) -> np.ndarray:
    """Add `count` bright, wandering streaks as from ripples on the water (float32, BGR)."""
    if count == 0:
        return image
    height, width = image.shape[:2]
    random = np.random.default_rng(seed)
    for _ in range(count):
        centre = random.uniform([0.0, 0.25 * height], [width, 0.75 * height])
        centre += (
            0.04 * width * np.sin(2.0 * np.pi * random.uniform(0.2, 0.8) * time_s + random.uniform(0, 6, 2))
        )
        length, thickness = random.uniform(0.01, 0.04) * width, random.uniform(0.001, 0.003) * width
        brightness = random.uniform(60.0, 200.0)
        _add_streak(image, centre, length, thickness, brightness)
    return image


def _add_streak(
    image: np.ndarray, centre: np.ndarray, length: float, thickness: float, brightness: float
) -> None:
    height, width = image.shape[:2]
    reach_x, reach_y = int(3 * length), int(3 * thickness) + 2
    left, right = np.clip([int(centre[0]) - reach_x, int(centre[0]) + reach_x], 0, width)
    top, bottom = np.clip([int(centre[1]) - reach_y, int(centre[1]) + reach_y], 0, height)
    x, y = np.arange(left, right) - centre[0], np.arange(top, bottom) - centre[1]
    streak = np.exp(-0.5 * (y[:, None] / thickness) ** 2) * np.exp(-0.5 * (x[None, :] / length) ** 2)
    image[top:bottom, left:right] += (brightness * streak[..., None]).astype(np.float32)


def add_noise(image: np.ndarray, noise_levels: float, frame_index: int, seed: int) -> np.ndarray:
    """Add sensor noise to an 8-bit BGR image; a stored pattern is shifted at random from frame to frame."""
    if noise_levels == 0.0:
        return image
    height, width = image.shape[:2]
    pattern = _noise_pattern(height + NOISE_MARGIN_PX, width + NOISE_MARGIN_PX, noise_levels, seed)
    random = np.random.default_rng((seed, frame_index))
    top, left = random.integers(0, NOISE_MARGIN_PX, 2)
    noise = pattern[top : top + height, left : left + width]
    return cv2.add(image, noise, dtype=cv2.CV_8U)


@lru_cache(maxsize=2)
def _noise_pattern(height: int, width: int, noise_levels: float, seed: int) -> np.ndarray:
    random = np.random.default_rng(seed)
    noise = random.standard_normal((height, width, 3), dtype=np.float32) * noise_levels
    return np.rint(noise).astype(np.int16)


def compress(image: np.ndarray, jpeg_quality: int) -> np.ndarray:
    """Send an 8-bit BGR image through JPEG with 4:2:0 chroma, as one frame of an MJPEG stream."""
    if jpeg_quality == 0:
        return image
    _, encoded = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, jpeg_quality])
    decoded = cv2.imdecode(encoded, cv2.IMREAD_COLOR)
    if decoded is None:
        raise TrackerError("OpenCV cannot read its own JPEG picture: install it anew.")
    return decoded
