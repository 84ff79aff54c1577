# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Paint shapes with smooth edges by taking many samples in each pixel."""

import cv2
import numpy as np

FINER = 4
DISC_SAMPLES = 8
TAG_CELLS = 8
BLUR_REACH = 4.0  # in σ: beyond, nothing of an 8-bit mask is left


class Canvas:
    """A picture in light levels (float32, BGR, 0 to 255), painted shape over shape."""

    def __init__(self, picture: np.ndarray) -> None:
        self.picture = picture.astype(np.float32)

    def disc(
        self, centre: np.ndarray, radius_px: float, colour: tuple[float, ...], strength: float = 1.0
    ) -> None:
        """A round dot, sampled 64 times in each pixel."""
        reach = int(np.ceil(radius_px)) + 2
        left, top = int(np.floor(centre[0])) - reach, int(np.floor(centre[1])) - reach
        size = 2 * reach + 2
        fine = (np.arange(size * DISC_SAMPLES) + 0.5) / DISC_SAMPLES - 0.5
        dx, dy = fine + left - centre[0], fine + top - centre[1]
        inside = (dx[None, :] ** 2 + dy[:, None] ** 2 <= radius_px**2).astype(np.float32)
        covered = inside.reshape(size, DISC_SAMPLES, size, DISC_SAMPLES).mean(axis=(1, 3))
        self._blend(left, top, covered * strength, colour)

    def strip(
        self, line: np.ndarray, half_width: np.ndarray, colour: tuple[float, ...], strength: float = 1.0
    ) -> None:
        """A band along a line (n, 2) of half width (n,), drawn four times finer and averaged."""
        tangent = np.gradient(line, axis=0)
        normal = np.column_stack([-tangent[:, 1], tangent[:, 0]]) / np.linalg.norm(tangent, axis=1)[:, None]
        edge = np.vstack([line + normal * half_width[:, None], (line - normal * half_width[:, None])[::-1]])
        self.polygon(edge, colour, strength)

    def polygon(self, corners: np.ndarray, colour: tuple[float, ...], strength: float = 1.0) -> None:
        """A filled polygon (n, 2)."""
        left, top = np.floor(corners.min(axis=0)).astype(int) - 1
        width, height = (np.ceil(corners.max(axis=0)).astype(int) + 2) - (left, top)
        # cv2 has pixel centres at whole numbers; the finer grid's pixels must lie inside the coarse ones.
        finer = (corners - (left, top) + 0.5) * FINER - 0.5
        mask = np.zeros((height * FINER, width * FINER), np.uint8)
        cv2.fillPoly(mask, [np.rint(finer * 16).astype(np.int32)], 255, cv2.LINE_8, 4)
        covered = cv2.resize(mask, (int(width), int(height)), interpolation=cv2.INTER_AREA) / np.float32(255)
        self._blend(int(left), int(top), covered * strength, colour)

    def tag(self, centre: np.ndarray, number: int, side_px: float, turn_rad: float) -> None:
        """An AprilTag 36h11 with a white rim, sampled 64 times in each pixel."""
        dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)
        code = cv2.aruco.generateImageMarker(dictionary, number, TAG_CELLS).astype(np.float32)
        code = np.pad(np.maximum(0.9 * code, 20.0), 1, constant_values=230.0)
        cell_px, cells = side_px / TAG_CELLS, len(code)
        reach = int(np.ceil(0.71 * cells * cell_px)) + 1
        left, top = np.floor(centre).astype(int) - reach
        size = 2 * reach + 2
        fine = (np.arange(size * DISC_SAMPLES) + 0.5) / DISC_SAMPLES - 0.5
        dx, dy = (fine + left - centre[0])[None, :], (fine + top - centre[1])[:, None]
        cosine, sine = np.cos(turn_rad), np.sin(turn_rad)
        column = np.floor((cosine * dx - sine * dy) / cell_px + 0.5 * cells).astype(int)
        row = np.floor((sine * dx + cosine * dy) / cell_px + 0.5 * cells).astype(int)
        inside = (np.minimum(row, column) >= 0) & (np.maximum(row, column) < cells)
        light = code[np.clip(row, 0, cells - 1), np.clip(column, 0, cells - 1)] * inside
        split = (size, DISC_SAMPLES, size, DISC_SAMPLES)
        covered = inside.astype(np.float32).reshape(split).mean(axis=(1, 3))
        mean = light.reshape(split).mean(axis=(1, 3)) / np.maximum(covered, 1e-6)
        self._blend(int(left), int(top), covered, mean)

    def shade(self, corners: np.ndarray, blur_px: float, depth: float) -> None:
        """A soft shadow of a polygon that takes the share `depth` of the light."""
        height, width = self.picture.shape[:2]
        reach = int(np.ceil(BLUR_REACH * blur_px)) + 2
        left, top = np.maximum(np.floor(corners.min(axis=0)).astype(int) - reach, 0)
        right, bottom = np.minimum(np.ceil(corners.max(axis=0)).astype(int) + reach + 1, (width, height))
        if left >= right or top >= bottom:
            return
        mask = np.zeros((bottom - top, right - left), np.uint8)
        cv2.fillPoly(mask, [np.rint(corners).astype(np.int32) - (left, top)], 255, cv2.LINE_AA)
        soft = cv2.GaussianBlur(mask, (0, 0), blur_px).astype(np.float32) / 255
        self.picture[top:bottom, left:right] *= (1.0 - depth * soft)[..., None]

    def _blend(
        self, left: int, top: int, covered: np.ndarray, colour: tuple[float, ...] | np.ndarray
    ) -> None:
        """Paint a colour, or grey levels of the shape of `covered`, to the share covered."""
        height, width = self.picture.shape[:2]
        x0, y0 = max(left, 0), max(top, 0)
        x1, y1 = min(left + covered.shape[1], width), min(top + covered.shape[0], height)
        if x0 >= x1 or y0 >= y1:
            return
        within = slice(y0 - top, y1 - top), slice(x0 - left, x1 - left)
        if isinstance(colour, np.ndarray):
            colour = colour[within][..., None]
        part = self.picture[y0:y1, x0:x1]
        part += covered[within][..., None] * (np.asarray(colour, np.float32) - part)
