"""Pictures of the swimmer as the camera over the tank takes them."""

import cv2
import numpy as np
from hasel_tracker_lab.rendering.camera_model import CameraView, Degradation
from hasel_tracker_lab.rendering.renderer import Renderer
from hasel_tracker_lab.rendering.swimmer_motion import BodyShape, line_through_markers

_JPEG_QUALITY = 92


class Drawing:
    """width, height [px]; scale [px/m]; noise: standard deviation in grey levels."""

    def __init__(self, width: int, height: int, scale: float, noise: float) -> None:
        self._body = _DrawnBody()
        view = CameraView(width, height, scale)
        self._renderer = Renderer(self._body, view, degradation=Degradation(noise_levels=noise))
        self._count = 0

    def jpeg(self, markers: np.ndarray) -> bytes:
        """One picture, with the markers at [3, 2] [m] from its middle."""
        self._body.line = line_through_markers(markers, self._renderer.shape)
        self._count += 1
        image = self._renderer.frame(0.0, self._count).image
        return cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])[1].tobytes()


class _DrawnBody:
    """A motion for the renderer, of which only this moment is known."""

    duration_s = np.inf

    def __init__(self) -> None:
        stations = np.array(BodyShape().marker_stations_m)
        straight = np.column_stack([stations - stations.mean(), np.zeros(3)])
        self.line = line_through_markers(straight, BodyShape())

    def centre_line(self, _: float) -> np.ndarray:
        return self.line
