"""The camera that looks at the swimming plane: pinhole, tilt and lens distortion."""

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np


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
