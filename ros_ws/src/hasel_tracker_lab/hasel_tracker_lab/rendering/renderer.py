# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Draw the swimmer, or a calibration's board, as a camera would see it, together with where its markers truly are."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import cv2
import numpy as np
from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.marker_set import bending_angle

from hasel_tracker_lab.rendering.camera_model import (
    CameraView,
    Degradation,
    add_glints,
    add_noise,
    compress,
    uneven_light,
)
from hasel_tracker_lab.rendering.swimmer_motion import BodyShape, RenderedMotion, points_at

SUB_EXPOSURES = 7
POLYGON_SHIFT = 5
WATER_COLOUR = (198, 196, 188)
SUPERSAMPLING = 3
PAPER, BLACK, TABLE = 235, 25, 150


@dataclass(frozen=True)
class RenderedFrame:
    """A picture (8-bit BGR), its time [s], the true markers (3, 2) in px and in m, and the true sin θ."""

    image: np.ndarray
    time_s: float
    markers_px: np.ndarray
    markers_m: np.ndarray
    sin_theta: float


@dataclass(frozen=True)
class Renderer:
    """Draws a motion; `background` is an 8-bit BGR image of the view's size, or None for plain water.

    `skin` is an 8-bit BGR image whose texture the body wears and carries along, or None for plain skin.
    """

    motion: RenderedMotion
    view: CameraView = field(default_factory=CameraView)
    shape: BodyShape = field(default_factory=BodyShape)
    degradation: Degradation = field(default_factory=Degradation)
    background: np.ndarray | None = None
    skin: np.ndarray | None = None

    def frames(self, frame_rate_hz: float = 120.0, count: int | None = None) -> Iterator[RenderedFrame]:
        """Frames at a fixed rate, for the motion's duration or for `count` of them."""
        total = count if count is not None else round(self.motion.duration_s * frame_rate_hz)
        for index in range(total):
            yield self.frame(index / frame_rate_hz, index)

    def frame(self, time_s: float, index: int = 0, hidden: tuple[int, ...] = ()) -> RenderedFrame:
        """One frame, exposed about `time_s`; `hidden` markers (0 head, 1 middle, 2 tail) are left out."""
        chain = self.degradation
        picture = self._exposed(time_s, hidden)
        picture = uneven_light(picture, chain.light_fall)
        picture = add_glints(picture, chain.glint_count, time_s, chain.seed)
        image = np.clip(picture + 0.5, 0.0, 255.0).astype(np.uint8)
        image = compress(add_noise(image, chain.noise_levels, index, chain.seed), chain.jpeg_quality)
        markers = self.markers_m(time_s)
        sin_theta, _ = bending_angle(markers * [1.0, -1.0])
        return RenderedFrame(image, time_s, self.view.to_pixels(markers), markers, sin_theta)

    def markers_m(self, time_s: float) -> np.ndarray:
        """True marker positions in the plane [m], shape (3, 2)."""
        line = self.motion.centre_line(time_s)
        return points_at(line, np.array(self.shape.marker_stations_m), self.shape.total_length_m)

    def _exposed(self, time_s: float, hidden: tuple[int, ...]) -> np.ndarray:
        water = self._water()
        exposure = self.degradation.exposure_s
        moments = [time_s] if exposure == 0.0 else time_s + exposure * _midpoints(SUB_EXPOSURES)
        total = np.zeros_like(water)
        for moment in moments:
            total += self._sharp(water, moment, hidden)
        total *= 1.0 / len(moments)
        return self._blurred(total)

    def _water(self) -> np.ndarray:
        if self.background is not None:
            return self.background.astype(np.float32)
        return np.full((self.view.height_px, self.view.width_px, 3), WATER_COLOUR, np.float32)

    def _sharp(self, water: np.ndarray, time_s: float, hidden: tuple[int, ...]) -> np.ndarray:
        picture = water.copy()
        line = self.motion.centre_line(time_s)
        stations = np.linspace(0.0, self.shape.total_length_m, len(line))
        self._paint(picture, line, self.shape.half_height(stations), self.shape.body_colour, self.skin)
        spine = np.full(len(line), 0.5 * self.shape.spine_thickness_m)
        self._paint(picture, line, spine, self.shape.spine_colour)
        for number, centre in enumerate(self.markers_m(time_s)):
            if number not in hidden:
                self._paint_marker(picture, centre)
        return picture

    def _paint(
        self,
        picture: np.ndarray,
        line_m: np.ndarray,
        half_height_m: np.ndarray,
        colour: tuple[int, ...],
        texture: np.ndarray | None = None,
    ) -> None:
        outline = self.view.to_pixels(_strip(line_m, half_height_m))
        fixed_point = np.rint(outline * 2**POLYGON_SHIFT).astype(np.int32)
        mask = np.zeros(picture.shape[:2], np.uint8)
        cv2.fillPoly(mask, [fixed_point], 255, cv2.LINE_AA, POLYGON_SHIFT)
        x, y, width, height = cv2.boundingRect(np.rint(outline).astype(np.int32))
        box = _slices(x - 2, y - 2, width + 4, height + 4, picture.shape)
        paint = np.array(colour, np.float32)
        if texture is not None:
            middle = self.view.to_pixels(line_m[len(line_m) // 2][None])[0]
            paint = paint * _carried(texture, middle - [box[1].start, box[0].start], mask[box].shape)
        _blend(picture, box, mask[box].astype(np.float32) / 255.0, paint)

    def _paint_marker(self, picture: np.ndarray, centre_m: np.ndarray) -> None:
        middle = self.view.to_pixels(centre_m[None])[0]
        reach = int(1.4 * self.shape.marker_radius_m * self.view.pixels_per_m) + 4
        corner = (int(middle[0]) - reach, int(middle[1]) - reach)
        size = 2 * reach + 1
        coverage = marker_coverage(self.view, centre_m, self.shape.marker_radius_m, corner, size)
        box = _slices(*corner, size, size, picture.shape)
        inside = coverage[
            box[0].start - corner[1] : box[0].stop - corner[1],
            box[1].start - corner[0] : box[1].stop - corner[0],
        ]
        _blend(picture, box, inside, np.array(self.shape.marker_colour, np.float32))

    def _blurred(self, picture: np.ndarray) -> np.ndarray:
        if self.degradation.blur_px == 0.0:
            return picture
        return cv2.GaussianBlur(picture, (0, 0), self.degradation.blur_px)


def _midpoints(count: int) -> np.ndarray:
    return (np.arange(count) + 0.5) / count - 0.5


def _strip(line_m: np.ndarray, half_height_m: np.ndarray) -> np.ndarray:
    tangent = np.gradient(line_m, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    normal = np.column_stack([-tangent[:, 1], tangent[:, 0]])
    upper, lower = line_m + normal * half_height_m[:, None], line_m - normal * half_height_m[:, None]
    return np.vstack([upper, lower[::-1]])


def _slices(x: int, y: int, width: int, height: int, shape: tuple[int, ...]) -> tuple[slice, slice]:
    left, right = np.clip([x, x + width], 0, shape[1])
    top, bottom = np.clip([y, y + height], 0, shape[0])
    return slice(int(top), int(bottom)), slice(int(left), int(right))


def _carried(texture: np.ndarray, middle: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """Relative brightness of a texture whose centre lies at `middle`, shape (height, width, 3)."""
    shift = middle - 0.5 * np.array(texture.shape[1::-1])
    move = np.array([[1.0, 0.0, shift[0]], [0.0, 1.0, shift[1]]])
    moved = cv2.warpAffine(texture, move, shape[::-1], borderMode=cv2.BORDER_REFLECT).astype(np.float32)
    return np.clip(moved / texture.mean(), 0.0, 1.15)


def _blend(picture: np.ndarray, box: tuple[slice, slice], coverage: np.ndarray, colour: np.ndarray) -> None:
    share = coverage[..., None]
    picture[box] = (1.0 - share) * picture[box] + share * colour


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


def photograph(path: Path, width_px: int, height_px: int) -> np.ndarray:
    """An image file scaled to fill a picture of this size, cropped in the middle; 8-bit BGR."""
    image = cv2.imread(str(path), cv2.IMREAD_COLOR)
    if image is None:
        raise TrackerError(f"The background {path} is not a readable image; give a PNG or JPEG file.")
    return filling(image, width_px, height_px)


def filling(image: np.ndarray, width_px: int, height_px: int) -> np.ndarray:
    """An 8-bit BGR or grey image scaled to fill a picture of this size, cropped in the middle; BGR."""
    if image.ndim == 2:
        image = cv2.cvtColor(image, cv2.COLOR_GRAY2BGR)
    scale = max(width_px / image.shape[1], height_px / image.shape[0])
    size = max(round(image.shape[1] * scale), width_px), max(round(image.shape[0] * scale), height_px)
    large = cv2.resize(image, size, interpolation=cv2.INTER_CUBIC)
    left, top = (size[0] - width_px) // 2, (size[1] - height_px) // 2
    return np.ascontiguousarray(large[top : top + height_px, left : left + width_px])


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
