"""Lens and perspective of a camera, applied to points (never to whole images)."""

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import yaml

from hasel_tracker.errors import TrackerError

KEYS = ("image_size_px", "camera_matrix", "distortion", "pixel_to_plane", "error_px")


@dataclass(frozen=True)
class CameraCalibration:
    """Pinhole matrix (3, 3) [px], OpenCV distortion (5,), homography (3, 3) undistorted pixel → plane [m].

    Plane axes keep the image's sense of rotation. `error_px`: rms distance of the board's corners from the
    model.
    """

    image_size_px: tuple[int, int]
    camera_matrix: np.ndarray
    distortion: np.ndarray
    pixel_to_plane: np.ndarray
    error_px: float

    def to_plane(self, points_px: np.ndarray, image_size_px: tuple[int, int]) -> np.ndarray:
        """Plane positions [m] of image points [px], both (n, 2); NaN stays NaN."""
        if tuple(image_size_px) != tuple(self.image_size_px):
            raise TrackerError(
                f"The image is {image_size_px[0]} × {image_size_px[1]} px but the calibration was made at "
                f"{self.image_size_px[0]} × {self.image_size_px[1]} px; calibrate again at the size you use."
            )
        straight = self.undistorted(points_px)
        return cv2.perspectiveTransform(straight.reshape(1, -1, 2), self.pixel_to_plane)[0]

    def undistorted(self, points_px: np.ndarray) -> np.ndarray:
        """Where the points [px] would be without lens distortion, shape (n, 2)."""
        points = np.asarray(points_px, float).reshape(1, -1, 2)
        if not self.distortion.any():
            return points[0]
        straight = cv2.undistortPoints(points, self.camera_matrix, self.distortion, P=self.camera_matrix)
        return straight.reshape(-1, 2)

    def save(self, path: Path) -> None:
        """Write the calibration as YAML."""
        values = {key: np.asarray(getattr(self, key)).tolist() for key in KEYS}
        Path(path).write_text(yaml.safe_dump(values, sort_keys=False))

    @classmethod
    def load(cls, path: Path) -> "CameraCalibration":
        """Read a calibration file written by `save`; raises TrackerError with what is wrong with it."""
        try:
            values = yaml.safe_load(Path(path).read_text())
        except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
            raise TrackerError(
                f"The calibration {path} cannot be read: {str(error).splitlines()[0]}."
            ) from error
        missing = [key for key in KEYS if not isinstance(values, dict) or key not in values]
        if missing:
            raise TrackerError(
                f"The calibration {path} lacks {', '.join(missing)}; make one with `calibrate board`."
            )
        try:
            return cls(
                tuple(int(each) for each in values["image_size_px"]),  # type: ignore[arg-type]
                np.array(values["camera_matrix"], float).reshape(3, 3),
                np.array(values["distortion"], float).reshape(5),
                np.array(values["pixel_to_plane"], float).reshape(3, 3),
                float(values["error_px"]),
            )
        except (TypeError, ValueError) as error:
            raise TrackerError(
                f"The calibration {path} has a value of the wrong size or kind ({error}); "
                "make one with `calibrate board`."
            ) from error

    def __str__(self) -> str:
        lens = "with lens distortion" if self.distortion.any() else "without lens distortion"
        width, height = self.image_size_px
        return (
            f"Calibration at {width} × {height} px, {lens}; "
            f"the board's corners fit to {self.error_px:.3f} px rms."
        )


def scale_calibration(
    first_px: np.ndarray, last_px: np.ndarray, distance_m: float, image_size_px: tuple[int, int]
) -> CameraCalibration:
    """Calibration of a camera that looks straight down, from two points (2,) [px] a known distance apart."""
    apart_px = float(np.linalg.norm(np.subtract(last_px, first_px)))
    if not (apart_px > 1.0 and distance_m > 0.0):
        raise TrackerError(
            f"The points are {apart_px:.1f} px and {distance_m:g} m apart; expected two points and a positive distance."
        )
    scale = distance_m / apart_px
    width, height = image_size_px
    return CameraCalibration((width, height), np.eye(3), np.zeros(5), np.diag([scale, scale, 1.0]), 0.0)
