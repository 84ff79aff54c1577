# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What several tests need: a small swimmer with three dots, drawn here in the simplest way, and its truth."""

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import pytest
from hasel_tracker.tracking.marker_set import bending_angle
from hasel_tracker.video.video_writer import JpegWriter

FRAME_RATE_HZ = 120.0
FINER = 4
LENGTH_PX, HALF_WIDTH_PX, DOT_RADIUS_PX = 500.0, 18.0, 6.0
STATIONS = np.array([0.03, 0.5, 0.97])
WATER, SKIN, BLUE = (198, 196, 188), (214, 222, 226), (168, 72, 22)


@dataclass(frozen=True)
class DrawnFrame:
    """A picture (8-bit BGR), its time [s], the true dots (3, 2) [px], head first, and the true sin θ."""

    image: np.ndarray
    time_s: float
    markers_px: np.ndarray
    sin_theta: float


def drawn(time_s: float, index: int) -> DrawnFrame:
    """A tapered body that rests for 0.1 s and then beats at 2 Hz, on 640 × 360 px."""
    share = np.linspace(0.0, 1.0, 200)
    beat = 0.36 * np.sin(4.0 * np.pi * max(time_s - 0.1, 0.0))
    turn = 2.0 * beat * (share - 0.5)
    steps = LENGTH_PX / (len(share) - 1) * np.column_stack([np.cos(turn), -np.sin(turn)])
    line = np.cumsum(steps, axis=0)
    line += [320.0, 180.0] - line.mean(axis=0)
    dots = np.column_stack([np.interp(STATIONS, share, line[:, axis]) for axis in (0, 1)])
    normal = np.column_stack([np.sin(turn), np.cos(turn)]) * (HALF_WIDTH_PX * (1.0 - 0.75 * share))[:, None]
    large = np.full((360 * FINER, 640 * FINER, 3), WATER, np.uint8)
    cv2.fillPoly(large, [_fine(np.vstack([line + normal, (line - normal)[::-1]]))], SKIN, cv2.LINE_AA, 4)
    for dot in _fine(dots):
        cv2.circle(large, tuple(dot.tolist()), round(16 * FINER * DOT_RADIUS_PX), BLUE, -1, cv2.LINE_AA, 4)
    image = cv2.GaussianBlur(cv2.resize(large, (640, 360), interpolation=cv2.INTER_AREA), (0, 0), 0.8)
    noise = np.random.default_rng(index).normal(0.0, 1.5, image.shape)
    image = np.clip(np.rint(image + noise), 0, 255).astype(np.uint8)
    return DrawnFrame(image, time_s, dots, bending_angle(dots)[0])


def _fine(points: np.ndarray) -> np.ndarray:
    """Places in the finer picture, as OpenCV takes them with four bits of a fraction."""
    return np.rint(16.0 * ((points + 0.5) * FINER - 0.5)).astype(np.int32)


@pytest.fixture(scope="session")
def frames() -> list[DrawnFrame]:
    """All 84 frames of that motion at 120 frames/s."""
    return [drawn(index / FRAME_RATE_HZ, index) for index in range(84)]


@pytest.fixture(scope="session")
def video(frames: list[DrawnFrame], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same as an MJPEG video."""
    path = tmp_path_factory.mktemp("video") / "swimmer.mp4"
    writer = JpegWriter(path, FRAME_RATE_HZ)
    for frame in frames:
        writer.write(frame.image, frame.time_s)
    writer.close()
    return path
