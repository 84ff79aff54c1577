# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Errors of a tracker on rendered pictures, condition by condition."""

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from hasel_tracker.calibration.camera_calibration import CameraCalibration
from hasel_tracker.errors import TrackerError
from hasel_tracker.offline.tracked_run import track_frames
from hasel_tracker.sources.frame import Frame
from hasel_tracker.sources.video_source import VideoSource
from hasel_tracker.tracking import DEFAULT_METHOD
from hasel_tracker.tracking.bending_tracker import BendingTracker
from hasel_tracker.video.video_writer import H264Writer

from hasel_tracker_lab.rendering.camera_model import CameraView, Degradation
from hasel_tracker_lab.rendering.renderer import RenderedFrame, Renderer, filling
from hasel_tracker_lab.rendering.swimmer_motion import BendingMotion

FRAME_RATE_HZ = 120.0


@dataclass(frozen=True)
class Condition:
    """A way of taking the picture; `photograph` and `skin` name pictures of scikit-image behind and on the body.

    pointed_at: the user points at the markers in the first frame, as the body cannot be told from the ground.
    """

    name: str
    degradation: Degradation = field(default_factory=Degradation)
    tilt_rad: float = 0.0
    radial_distortion: float = 0.0
    photograph: str = ""
    skin: str = ""
    h264_rate_factor: int | None = None
    at_rest: bool = False
    pointed_at: bool = False


CONDITIONS = (
    Condition("clean"),
    Condition("noisy (σ 3)", Degradation(noise_levels=3.0)),
    Condition("MJPEG quality 75", Degradation(noise_levels=2.0, jpeg_quality=75)),
    Condition("MJPEG quality 50", Degradation(noise_levels=2.0, jpeg_quality=50)),
    Condition("H.264 (crf 18)", Degradation(noise_levels=2.0), h264_rate_factor=18),
    Condition("badly lit, reflections", Degradation(noise_levels=3.0, light_fall=0.6, glint_count=12)),
    Condition("blurred optics (σ 2 px)", Degradation(noise_levels=2.0, blur_px=2.0)),
    Condition("motion blur (4 ms)", Degradation(noise_levels=2.0, exposure_s=0.004)),
    Condition("tilted 15°, lens", Degradation(noise_levels=2.0), tilt_rad=0.26, radial_distortion=-0.1),
    Condition(
        "photograph: gravel, with --at",
        Degradation(noise_levels=2.0, jpeg_quality=75),
        photograph="gravel",
        pointed_at=True,
    ),
    Condition("photograph: coffee", Degradation(noise_levels=2.0, jpeg_quality=75), photograph="coffee"),
    Condition("photograph on the skin: brick", Degradation(noise_levels=2.0, jpeg_quality=75), skin="brick"),
    Condition("at rest, MJPEG 75", Degradation(noise_levels=3.0, jpeg_quality=75), at_rest=True),
)


@dataclass(frozen=True)
class Accuracy:
    """rms distance of each marker (3,) from the truth [px]; sin θ error: rms and spread; share lost."""

    condition: str
    marker_rms_px: np.ndarray
    sin_theta_rms: float
    sin_theta_spread: float
    lost_share: float

    def __str__(self) -> str:
        head, middle, tail = self.marker_rms_px
        return (
            f"{self.condition}: {head:.4f}, {middle:.4f}, {tail:.4f} px rms, sin θ "
            f"{self.sin_theta_rms:.1e} rms, "
            f"{100 * self.lost_share:.0f} % lost."
        )


def measure_accuracy(
    condition: Condition,
    frames: int,
    method: str = DEFAULT_METHOD,
    width_px: int = 1920,
    height_px: int = 1080,
) -> Accuracy:
    """Track `frames` rendered pictures of a condition and compare with the truth."""
    renderer = renderer_for(condition, width_px, height_px)
    calibration = exact_calibration(renderer.view) if condition.tilt_rad else None
    truth = list(pictures(renderer, condition, frames))
    run = track_frames(
        (Frame(index, frame.time_s, image=frame.image) for index, frame in enumerate(truth)),
        BendingTracker(method=method, calibration=calibration),
        placed={0: truth[0].markers_px} if condition.pointed_at else None,
    )
    squared = ((run.markers_px - [frame.markers_px for frame in truth]) ** 2).sum(axis=2)
    angle_errors = run.sin_theta - [frame.sin_theta for frame in truth]
    return Accuracy(
        condition.name,
        np.sqrt(np.nanmean(squared, axis=0)),
        float(np.sqrt(np.nanmean(angle_errors**2))),
        float(np.nanstd(angle_errors)),
        float(np.isnan(angle_errors).mean()),
    )


def renderer_for(condition: Condition, width_px: int = 1920, height_px: int = 1080) -> Renderer:
    """The renderer of a condition; a smaller picture shows the swimmer equally large in proportion."""
    motion = BendingMotion(amplitude_rad=0.0 if condition.at_rest else 0.6, duration_s=1.0)
    view = CameraView(
        width_px,
        height_px,
        6000.0 * width_px / 1920,
        tilt_rad=condition.tilt_rad,
        radial_distortion=condition.radial_distortion,
    )
    background, skin = (
        _photograph(name, width_px, height_px) if name else None
        for name in (condition.photograph, condition.skin)
    )
    return Renderer(motion, view, degradation=condition.degradation, background=background, skin=skin)


def _photograph(name: str, width_px: int, height_px: int) -> np.ndarray:
    from skimage import data  # only the benchmark and the tests need photographs

    picture = getattr(data, name)()
    picture = picture[..., ::-1] if picture.ndim == 3 else picture
    return filling(np.ascontiguousarray(picture), width_px, height_px)


def pictures(renderer: Renderer, condition: Condition, count: int) -> Iterator[RenderedFrame]:
    """Rendered frames, sent through H.264 if the condition says so."""
    if condition.h264_rate_factor is None:
        yield from renderer.frames(FRAME_RATE_HZ, count)
        return
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "condition.mp4"
        writer = H264Writer(path, FRAME_RATE_HZ, condition.h264_rate_factor)
        truth = []
        for frame in renderer.frames(FRAME_RATE_HZ, count):
            writer.write(frame.image, frame.time_s)
            truth.append((frame.time_s, frame.markers_px, frame.markers_m, frame.sin_theta))
        writer.close()
        for decoded, known in zip(VideoSource(path, threads=1), truth, strict=True):
            yield RenderedFrame(image_of(decoded), *known)


def image_of(frame: Frame) -> np.ndarray:
    """Its image, decoded where need be. Raises TrackerError where there is none."""
    image = frame.decoded().image
    if image is None:
        raise TrackerError(f"Frame {frame.index} has no picture: give it an image or its JPEG code.")
    return image


def exact_calibration(view: CameraView) -> CameraCalibration:
    """The calibration that a perfect board would give for a view (plane with y down, as in the image)."""
    flip = np.diag([1.0, -1.0, 1.0])
    pixel_to_plane = flip @ np.linalg.inv(view.plane_to_pixel)
    size = (view.width_px, view.height_px)
    return CameraCalibration(size, view.camera_matrix, view.distortion, pixel_to_plane, 0.0)
