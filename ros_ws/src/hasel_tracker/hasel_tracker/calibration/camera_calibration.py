# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Lens and perspective of a camera, from pictures of a chessboard or a known distance, applied to points."""

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import yaml

from hasel_tracker.calibration import VIEWS_FOR_LENS
from hasel_tracker.errors import TrackerError

KEYS = ("image_size_px", "camera_matrix", "distortion", "pixel_to_plane", "error_px")
VIEWS_FOR_HIGHER_TERMS = 10


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

    @property
    def has_lens(self) -> bool:
        """Whether the lens was calibrated, and not the perspective or a scale only."""
        return not np.array_equal(self.camera_matrix, np.eye(3))

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


@dataclass(frozen=True)
class Board:
    """A chessboard: inner corners per row and per column, and the side of a square [m]."""

    columns: int = 9
    rows: int = 6
    square_m: float = 0.01

    def __post_init__(self) -> None:
        if self.columns < 3 or self.rows < 3 or not self.square_m > 0.0:
            raise TrackerError(
                f"The board has {self.columns} × {self.rows} inner corners and {self.square_m} m squares; "
                "expected at least 3 × 3 corners and a positive size."
            )

    def corners_m(self) -> np.ndarray:
        """Corner positions on the board [m], shape (columns · rows, 3), z = 0."""
        column, row = np.meshgrid(np.arange(self.columns), np.arange(self.rows))
        flat = np.column_stack([column.ravel(), row.ravel(), np.zeros(column.size)])
        return (flat * self.square_m).astype(np.float32)


def find_corners(image: np.ndarray, board: Board, name: str) -> np.ndarray:
    """Corner positions [px] in an 8-bit BGR image, shape (n, 1, 2); TrackerError if the board is not seen."""
    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
    found, corners = cv2.findChessboardCornersSB(
        grey, (board.columns, board.rows), flags=cv2.CALIB_CB_ACCURACY
    )
    if not found:
        raise TrackerError(
            f"No board of {board.columns} × {board.rows} inner corners is seen in {name}; "
            "count the inner corners, and show the whole board with a white rim."
        )
    return corners


def calibrate_camera(
    views: list[np.ndarray], plane_view: np.ndarray, board: Board, image_size_px: tuple[int, int]
) -> CameraCalibration:
    """Calibration from corner sets (n, 1, 2) [px]; `plane_view` is the board lying in the swimming plane.

    The lens needs at least four views in different poses; with fewer, only the perspective is calibrated.
    """
    matrix, distortion = np.eye(3), np.zeros(5)
    corners_m = board.corners_m()
    if len(views) >= VIEWS_FOR_LENS:
        # Few views leave the higher terms of the lens undetermined, and they spoil the rim of the picture.
        fixed = cv2.CALIB_FIX_K3
        if len(views) < VIEWS_FOR_HIGHER_TERMS:
            fixed |= cv2.CALIB_FIX_K2 | cv2.CALIB_ZERO_TANGENT_DIST
        _, matrix, distortion, _, _ = cv2.calibrateCamera(
            [corners_m] * len(views), views, image_size_px, None, None, flags=fixed
        )
        distortion = distortion.ravel()[:5]
    lens = CameraCalibration(image_size_px, matrix, distortion, np.eye(3), 0.0)
    straight = lens.undistorted(plane_view.reshape(-1, 2))
    target = _same_sense(corners_m[:, :2].astype(float), straight, board)
    homography, _ = cv2.findHomography(straight, target)
    back = cv2.perspectiveTransform(target.reshape(1, -1, 2), np.linalg.inv(homography))[0]
    error = float(np.sqrt(((back - straight) ** 2).sum(axis=1).mean()))
    return CameraCalibration(image_size_px, matrix, distortion, homography, error)


def _same_sense(corners_m: np.ndarray, seen_px: np.ndarray, board: Board) -> np.ndarray:
    """The board's coordinates, with y flipped if the corners run round the other way than in the image."""
    along, down = seen_px[1] - seen_px[0], seen_px[board.columns] - seen_px[0]
    if along[0] * down[1] - along[1] * down[0] > 0.0:
        return corners_m
    return corners_m * [1.0, -1.0]
