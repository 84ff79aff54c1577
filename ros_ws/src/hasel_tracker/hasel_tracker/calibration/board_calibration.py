"""Calibrate the camera from pictures of a chessboard; one of them lies in the swimming plane."""

from dataclasses import dataclass

import cv2
import numpy as np

from hasel_tracker.calibration import VIEWS_FOR_LENS
from hasel_tracker.calibration.camera_calibration import CameraCalibration
from hasel_tracker.errors import TrackerError

VIEWS_FOR_HIGHER_TERMS = 10


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
