"""A chessboard lying in the plane, as the camera would see it, to test the calibration."""

import cv2
import numpy as np

from hasel_tracker_lab.rendering.camera_view import CameraView

PAPER, BLACK, TABLE = 235, 25, 150
SUPERSAMPLING = 3


def board_picture(view: CameraView, columns: int, rows: int, square_m: float) -> np.ndarray:
    """8-bit BGR picture of a board with so many inner corners, centred at the origin of the plane."""
    fine = SUPERSAMPLING
    x = (np.arange(view.width_px * fine) + 0.5) / fine - 0.5
    y = (np.arange(view.height_px * fine) + 0.5) / fine - 0.5
    pixels = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    plane = view.to_plane(pixels)
    column = np.floor(plane[:, 0] / square_m + 0.5 * (columns + 1)).astype(int)
    row = np.floor(-plane[:, 1] / square_m + 0.5 * (rows + 1)).astype(int)
    inside = (column >= 0) & (column <= columns) & (row >= 0) & (row <= rows)
    rim = (column >= -1) & (column <= columns + 1) & (row >= -1) & (row <= rows + 1)
    grey = np.where(inside & ((column + row) % 2 == 0), BLACK, np.where(rim, PAPER, TABLE)).astype(np.float32)
    picture = grey.reshape(view.height_px, fine, view.width_px, fine).mean(axis=(1, 3))
    picture = cv2.GaussianBlur(picture, (0, 0), 0.8)
    return cv2.cvtColor(np.rint(picture).astype(np.uint8), cv2.COLOR_GRAY2BGR)
