# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What several tests need: a small rendered swimmer, in memory and as a video."""

from pathlib import Path

import pytest
from hasel_tracker_lab.rendering.camera_model import CameraView, Degradation
from hasel_tracker_lab.rendering.render import write_frames
from hasel_tracker_lab.rendering.renderer import RenderedFrame, Renderer
from hasel_tracker_lab.rendering.swimmer_motion import BendingMotion

SMALL_VIEW = CameraView(640, 360, 2800.0)


@pytest.fixture(scope="session")
def renderer() -> Renderer:
    """A swimmer at 640 × 360 px that rests for 0.1 s and then beats at 4 Hz."""
    motion = BendingMotion(amplitude_rad=0.6, frequency_hz=4.0, duration_s=0.7, rest_s=0.1)
    return Renderer(motion, SMALL_VIEW, degradation=Degradation(noise_levels=1.5))


@pytest.fixture(scope="session")
def frames(renderer: Renderer) -> list[RenderedFrame]:
    """All 84 frames of that motion at 120 frames/s."""
    return list(renderer.frames(120.0))


@pytest.fixture(scope="session")
def video(renderer: Renderer, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same as an MJPEG video."""
    path = tmp_path_factory.mktemp("video") / "swimmer.mp4"
    write_frames(renderer, path, 120.0, "mjpeg", 90)
    return path
