# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Options of `bench` and `render`, and where both begin: read before anything heavy is imported, so that --help answers
at once."""

import argparse
from collections.abc import Sequence
from pathlib import Path

from hasel_common.command_entry import command

from hasel_tracker_lab.rendering import CODECS


@command
def bench(arguments: Sequence[str] | None = None) -> int:
    """`bench`."""
    options = bench_parser().parse_args(arguments)
    from hasel_tracker_lab.bench.tracker_bench import run

    return run(options)


@command
def render(arguments: Sequence[str] | None = None) -> int:
    """`render OUTPUT`."""
    options = render_parser().parse_args(arguments)
    from hasel_tracker_lab.rendering.render import run

    return run(options)


def bench_parser() -> argparse.ArgumentParser:
    """Options of `bench`."""
    options = argparse.ArgumentParser(prog="bench", description="Measure the tracker against rendered truth.")
    options.add_argument("--frames", type=int, default=60, help="per condition (default: %(default)s)")
    options.add_argument("--json", type=Path, metavar="FILE", help="write the results as JSON too")
    return options


def render_parser() -> argparse.ArgumentParser:
    """Options of `render`."""
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


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.partition("x")
    if not (width.isdigit() and height.isdigit() and min(int(width), int(height)) >= 64):
        raise argparse.ArgumentTypeError(f"'{text}' is not a size WIDTHxHEIGHT of at least 64 px each")
    return int(width), int(height)
