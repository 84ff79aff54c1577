"""How much of each pixel a round marker covers, with perspective and lens, to a thousandth of a pixel."""

import numpy as np

from hasel_tracker_lab.rendering.camera_view import CameraView

SUPERSAMPLING = 3


def marker_coverage(
    view: CameraView, centre_m: np.ndarray, radius_m: float, corner_px: tuple[int, int], size_px: int
) -> np.ndarray:
    """Share of each pixel covered by a disc in the plane, shape (size, size); `corner_px` is its top left."""
    fine = SUPERSAMPLING
    offsets = (np.arange(size_px * fine) + 0.5) / fine - 0.5
    x, y = np.meshgrid(corner_px[0] + offsets, corner_px[1] + offsets)
    plane = view.to_plane(np.column_stack([x.ravel(), y.ravel()]))
    distance = np.hypot(*(plane - centre_m).T).reshape(x.shape)
    by_row, by_column = np.gradient(distance)
    # Distance to the edge in fine pixels; a linear ramp over one of them is the pixel's coverage.
    to_edge = (distance - radius_m) / np.maximum(np.hypot(by_row, by_column), 1e-12)
    covered = np.clip(0.5 - to_edge, 0.0, 1.0)
    return covered.reshape(size_px, fine, size_px, fine).mean(axis=(1, 3)).astype(np.float32)
