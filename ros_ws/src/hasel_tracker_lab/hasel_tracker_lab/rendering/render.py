# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`render OUTPUT`: a swimmer whose markers' true places are known, as a video or images, and the truth beside."""

import argparse
from collections.abc import Callable
from itertools import count
from pathlib import Path

import cv2
import numpy as np
from hasel_common.progress import counted
from hasel_recording import Recording, RecordingError, write_recording
from hasel_tracker.errors import TrackerError, run_command
from hasel_tracker.video.video_writer import H264Writer, JpegWriter

from hasel_tracker_lab.rendering import CODECS
from hasel_tracker_lab.rendering.camera_model import CameraView, Degradation
from hasel_tracker_lab.rendering.motion_file import read_motion
from hasel_tracker_lab.rendering.renderer import RenderedFrame, Renderer, photograph
from hasel_tracker_lab.rendering.swimmer_motion import BendingMotion, BodyShape, RenderedMotion

USUAL_QUALITY = {"mjpeg": 90, "h264": 20}


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    return run_command(lambda: _render(options))


def _render(options: argparse.Namespace) -> None:
    if not (options.frame_rate > 0.0 and options.duration > 0.0 and options.scale > 0.0):
        raise TrackerError("The frame rate, duration and scale must be positive.")
    if not 0.0 <= options.light_fall < 1.0:
        raise TrackerError(f"The light fall is {options.light_fall}; expected 0 to below 1.")
    shape = BodyShape()
    renderer = Renderer(
        _motion(options, shape),
        _view(options),
        shape,
        _degradation(options),
        _photograph(options.background, options.size),
        _photograph(options.skin, options.size),
    )
    quality = USUAL_QUALITY[options.codec] if options.quality is None else options.quality
    total = max(round(renderer.motion.duration_s * options.frame_rate), 1)
    numbers = count(1)
    with counted("rendering", "frames", total) as done:
        truth = write_frames(
            renderer,
            options.output,
            options.frame_rate,
            options.codec,
            quality,
            lambda _: done(next(numbers)),
            total,
        )
    path = options.truth or options.output.with_name(f"{options.output.stem}_truth.csv")
    write_truth(truth, path)
    print(f"Wrote {total} frames to {options.output} and the truth to {path}.")


def _motion(options: argparse.Namespace, shape: BodyShape) -> RenderedMotion:
    if options.motion is not None:
        return read_motion(options.motion, shape)
    return BendingMotion(options.amplitude, options.frequency, options.duration, options.rest, shape=shape)


def _view(options: argparse.Namespace) -> CameraView:
    width, height = options.size
    tilt, roll = np.radians([options.tilt, options.roll])
    return CameraView(
        width,
        height,
        1000.0 * options.scale,
        tilt_rad=float(tilt),
        roll_rad=float(roll),
        radial_distortion=options.lens,
    )


def _degradation(options: argparse.Namespace) -> Degradation:
    return Degradation(options.blur, options.exposure, options.noise, options.light_fall, options.glints)


def _photograph(path: Path | None, size_px: tuple[int, int]) -> np.ndarray | None:
    return None if path is None else photograph(path, *size_px)


def write_frames(
    renderer: Renderer,
    output: Path,
    frame_rate_hz: float,
    codec: str,
    quality: int,
    seen: Callable[[int], None] = lambda _: None,
    count: int | None = None,
) -> Recording:
    """Render into a video file, or PNG images if `output` has no suffix; returns the truth [px].

    `quality`: JPEG quality (1 to 100) for mjpeg, constant rate factor (0 to 51) for h264. `seen` gets each
    index.
    """
    write, close = _sink(output, frame_rate_hz, codec, quality)
    times, markers, angles = [], [], []
    try:
        for index, frame in enumerate(renderer.frames(frame_rate_hz, count)):
            write(frame)
            times.append(frame.time_s)
            markers.append(frame.markers_px)
            angles.append(frame.sin_theta)
            seen(index)
    finally:
        close()
    return Recording(output.stem, np.array(times), np.array(angles), None, np.array(markers), "px")


def write_truth(truth: Recording, path: Path) -> None:
    """Write true times, marker positions [px] and sin θ as a recording."""
    try:
        write_recording(truth, path)
    except RecordingError as error:
        raise TrackerError(str(error)) from error


def _sink(
    output: Path, frame_rate_hz: float, codec: str, quality: int
) -> tuple[Callable[[RenderedFrame], None], Callable[[], None]]:
    if output.suffix == "":
        output.mkdir(parents=True, exist_ok=True)
        return lambda frame: _write_image(output, frame, frame_rate_hz), lambda: None
    if codec not in CODECS:
        raise TrackerError(f"The codec is '{codec}'; expected {' or '.join(CODECS)}.")
    if codec == "h264":
        video = H264Writer(output, frame_rate_hz, quality)
    else:
        video = JpegWriter(output, frame_rate_hz, quality)
    return lambda frame: video.write(frame.image, frame.time_s), video.close


def _write_image(folder: Path, frame: RenderedFrame, frame_rate_hz: float) -> None:
    path = folder / f"frame_{round(frame.time_s * frame_rate_hz):06d}.png"
    if not cv2.imwrite(str(path), frame.image, [cv2.IMWRITE_PNG_COMPRESSION, 1]):
        raise TrackerError(f"The image {path} cannot be written; choose another folder.")
