"""`render OUTPUT`: pictures of a swimmer whose markers' true positions are known."""

import argparse
import sys
from collections.abc import Sequence
from itertools import count
from pathlib import Path

import numpy as np
from hasel_common.progress import counted
from hasel_tracker.commands.command import run_command
from hasel_tracker.errors import TrackerError

from hasel_tracker_lab.rendering.background import photograph
from hasel_tracker_lab.rendering.body_shape import BodyShape
from hasel_tracker_lab.rendering.camera_view import CameraView
from hasel_tracker_lab.rendering.degradation import Degradation
from hasel_tracker_lab.rendering.motion import BendingMotion, RenderedMotion
from hasel_tracker_lab.rendering.motion_file import read_motion
from hasel_tracker_lab.rendering.render_output import write_frames, write_truth
from hasel_tracker_lab.rendering.renderer import Renderer
from hasel_tracker_lab.tracker_lab_commands import render_parser

USUAL_QUALITY = {"mjpeg": 90, "h264": 20}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return run(render_parser().parse_args(arguments))


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


if __name__ == "__main__":
    sys.exit(main())
