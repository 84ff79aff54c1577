"""Write rendered frames as video or images, and the truth beside them."""

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
from hasel_recording import Recording, RecordingError, write_recording
from hasel_tracker.errors import TrackerError
from hasel_tracker.video.video_writer import H264Writer, JpegWriter

from hasel_tracker_lab.rendering.renderer import RenderedFrame, Renderer
from hasel_tracker_lab.tracker_lab_commands import CODECS


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
