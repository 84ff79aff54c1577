"""`render OUTPUT`: pictures of a swimmer whose markers' true positions are known."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from hasel_tracker.commands.command import progress_bar, run_command
from hasel_tracker.errors import TrackerError
from hasel_tracker.render.background import photograph
from hasel_tracker.render.body_shape import BodyShape
from hasel_tracker.render.camera_view import CameraView
from hasel_tracker.render.degradation import Degradation
from hasel_tracker.render.motion import BendingMotion, Motion
from hasel_tracker.render.motion_file import read_motion
from hasel_tracker.render.render_output import CODECS, write_frames, write_truth
from hasel_tracker.render.renderer import Renderer

USUAL_QUALITY = {"mjpeg": 90, "h264": 20}


def parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(prog="render", description="Draw the swimmer as a camera would see it.")
    add = options.add_argument
    add("output", type=Path, help="video (.mp4, .mkv, .avi), or a folder for PNG images")
    add("--truth", type=Path, help="recording of the truth to write (default: OUTPUT with _truth.csv)")
    add("--motion", type=Path, help="recording with markers [m], sin_theta or centre lines; else a sine")
    add(
        "--amplitude",
        type=float,
        default=0.6,
        metavar="RAD",
        help="bend from head to tail (default: %(default)g)",
    )
    add("--frequency", type=float, default=2.0, metavar="HZ", help="default: %(default)g")
    add("--duration", type=float, default=1.0, metavar="S", help="default: %(default)g")
    add(
        "--rest",
        type=float,
        default=0.0,
        metavar="S",
        help="time at rest before moving (default: %(default)g)",
    )
    add("--frame-rate", type=float, default=120.0, metavar="HZ", help="default: %(default)g")
    add("--size", type=_size, default=(1920, 1080), metavar="WxH", help="default: 1920x1080")
    add("--scale", type=float, default=6.0, metavar="PX_PER_MM", help="default: %(default)g")
    add("--tilt", type=float, default=0.0, metavar="DEG", help="of the camera: perspective")
    add(
        "--roll", type=float, default=0.0, metavar="DEG", help="of the camera; 180 puts the head on the right"
    )
    add("--lens", type=float, default=0.0, metavar="K1", help="radial distortion coefficient")
    add("--blur", type=float, default=0.8, metavar="PX", help="standard deviation (default: %(default)g)")
    add("--exposure", type=float, default=0.0, metavar="S", help="shutter time: motion blur")
    add("--noise", type=float, default=0.0, metavar="LEVELS", help="standard deviation in grey levels")
    add(
        "--light-fall", type=float, default=0.0, metavar="SHARE", help="light lost across the picture, 0 to 1"
    )
    add("--glints", type=int, default=0, metavar="N", help="reflections on the water")
    add("--background", type=Path, help="photograph to put behind the swimmer")
    add("--skin", type=Path, help="photograph whose texture the body wears")
    add("--codec", choices=CODECS, default="mjpeg", help="default: %(default)s")
    add("--quality", type=int, help="JPEG quality 1 to 100 (90), or H.264 constant rate factor 0 to 51 (20)")
    return options


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    options = parser().parse_args(arguments)
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
    with progress_bar() as progress:
        task = progress.add_task("rendering", total=total)
        truth = write_frames(
            renderer, options.output, options.frame_rate, options.codec, quality,
            lambda _: progress.advance(task), total,
        )  # fmt: skip
    path = options.truth or options.output.with_name(f"{options.output.stem}_truth.csv")
    write_truth(truth, path)
    print(f"Wrote {total} frames to {options.output} and the truth to {path}.")


def _motion(options: argparse.Namespace, shape: BodyShape) -> Motion:
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


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.partition("x")
    if not (width.isdigit() and height.isdigit() and min(int(width), int(height)) >= 64):
        raise argparse.ArgumentTypeError(f"'{text}' is not a size WIDTHxHEIGHT of at least 64 px each")
    return int(width), int(height)


if __name__ == "__main__":
    sys.exit(main())
