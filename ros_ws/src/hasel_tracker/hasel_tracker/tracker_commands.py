# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Options of `track` and `calibrate`, and where these and `tracker_node` begin: before anything heavy is imported, so
that --help answers at once and opens no camera."""

import argparse
from collections.abc import Sequence
from pathlib import Path

from hasel_common.command_entry import command

from hasel_tracker.calibration import VIEWS_FOR_LENS
from hasel_tracker.tracking import BODY_KINDS, DEFAULT_METHOD, METHODS


@command
def calibrate(arguments: Sequence[str] | None = None) -> int:
    """`calibrate colour|body|board|distance`."""
    options = calibrate_parser().parse_args(arguments)
    from hasel_tracker.calibration.calibrate import run

    return run(options)


@command
def track(arguments: Sequence[str] | None = None) -> int:
    """`track VIDEO`."""
    options = track_parser().parse_args(arguments)
    from hasel_tracker.offline.track import run

    return run(options)


@command
def tracker_node() -> int:
    """The node, until it is interrupted."""
    from hasel_common.node_parameter import answer_help

    from hasel_tracker.tracker_parameters import PARAMETERS

    answer_help(
        "tracker_node",
        "Follows the markers of a camera or video and publishes the bending angle (/hasel/bending/measured).",
        [each.usage for each in PARAMETERS],
    )
    from hasel_tracker.tracker_node import main as run

    return run()


def calibrate_parser() -> argparse.ArgumentParser:
    """Options of `calibrate`."""
    options = argparse.ArgumentParser(prog="calibrate", description="Set the tracker up for a rig.")
    kinds = options.add_subparsers(dest="kind", required=True)
    colour = kinds.add_parser("colour", help="learn the markers' colour and size from one frame")
    colour.add_argument("frame", type=Path, help="image, or video (its first frame)")
    colour.add_argument("--at", type=_point, nargs="+", metavar="X,Y", help="a pixel on each marker")
    colour.add_argument(
        "--output", "-o", type=Path, default=Path("markers.yaml"), help="default: %(default)s"
    )
    colour.add_argument("--show", type=Path, metavar="PNG", help="write a picture of what is seen")
    body = kinds.add_parser("body", help="see how a swimmer without dots stands out (--method midline)")
    body.add_argument("frame", type=Path, help="image, or video (its first frame)")
    body.add_argument("--body", choices=BODY_KINDS, default="auto", help="against the ground (default: auto)")
    body.add_argument("--roi", type=_region, metavar="X,Y,W,H", help="look only within this part")
    body.add_argument("--output", "-o", type=Path, default=Path("markers.yaml"), help="default: %(default)s")
    body.add_argument("--show", type=Path, metavar="PNG", help="write a picture of what is seen")
    board = kinds.add_parser("board", help="lens and perspective from pictures of a chessboard")
    board.add_argument(
        "images", type=Path, nargs="*", help=f"views in other poses, for the lens ({VIEWS_FOR_LENS} or more)"
    )
    board.add_argument("--plane", type=Path, required=True, help="picture of the board in the swimming plane")
    board.add_argument("--columns", type=int, default=9, help="inner corners per row (default: %(default)s)")
    board.add_argument("--rows", type=int, default=6, help="inner corners per column (default: %(default)s)")
    board.add_argument("--square", type=float, required=True, metavar="M", help="side of a square [m]")
    board.add_argument("--output", "-o", type=Path, default=Path("camera.yaml"), help="default: %(default)s")
    distance = kinds.add_parser("distance", help="metres per pixel from two points a known distance apart")
    distance.add_argument(
        "frame", type=Path, help="image, or video (its first frame), seen straight from above"
    )
    distance.add_argument(
        "--between", type=_point, nargs=2, required=True, metavar="X,Y", help="the two points [px]"
    )
    distance.add_argument("--metres", type=float, required=True, metavar="M", help="their distance [m]")
    distance.add_argument(
        "--output", "-o", type=Path, default=Path("camera.yaml"), help="default: %(default)s"
    )
    return options


def track_parser() -> argparse.ArgumentParser:
    """Options of `track`."""
    options = argparse.ArgumentParser(prog="track", description="Track the markers of a video.")
    options.add_argument("video", type=Path, help="video file, or folder of images")
    options.add_argument("--output", "-o", type=Path, required=True, help="recording to write: .csv or .mcap")
    options.add_argument(
        "--annotate", type=Path, metavar="VIDEO", help="write a video of what was found (H.264)"
    )
    options.add_argument("--method", choices=METHODS, default=DEFAULT_METHOD, help="default: %(default)s")
    options.add_argument(
        "--markers", type=int, metavar="N", help="how many, 2 to 15 (default: 3, or as --settings says)"
    )
    options.add_argument(
        "--points",
        metavar="N|S,S,…",
        help="of midline: how many points, or at which shares of the length from the head",
    )
    options.add_argument(
        "--body", choices=BODY_KINDS, help="of midline: how the body stands out (default: auto)"
    )
    options.add_argument(
        "--head", metavar="SIDE", help="where the head is in the first frame: left, right, top, bottom or X,Y"
    )
    options.add_argument(
        "--at",
        type=_point,
        nargs="+",
        metavar="X,Y",
        help="the markers in the first frame, head first, by hand",
    )
    options.add_argument(
        "--fix", type=Path, metavar="FILE", help="frames and the markers' positions in them, by hand (YAML)"
    )
    options.add_argument(
        "--roi", type=_region, metavar="X,Y,W,H", help="look only within this part of the picture"
    )
    options.add_argument(
        "--box", type=_box, nargs="+", metavar="X,Y,W,H", help="boxes for csrt, from head to tail"
    )
    options.add_argument("--settings", type=Path, help="colour, size and region, from `calibrate colour`")
    options.add_argument("--calibration", type=Path, help="lens and perspective, from `calibrate board`")
    options.add_argument(
        "--mirrored", action="store_true", help="the camera looks from below or over a mirror"
    )
    options.add_argument(
        "--frame-rate",
        type=float,
        metavar="HZ",
        help="how fast the pictures were taken, in place of what a video says; needed for images",
    )
    options.add_argument("--drive", type=Path, help="the drive's recording (.mcap or .csv), to merge")
    options.add_argument("--merge", choices=("auto", "stamp", "lag"), default="auto",
                         help="by stamp, by the lag found, or stamp if both have it (default)")  # fmt: skip
    options.add_argument(
        "--lag", type=float, metavar="SECONDS", help="merge by this lag, added to the drive's time"
    )
    options.add_argument(
        "--led",
        type=_region,
        metavar="X,Y,W,H",
        help="merge by a lamp here that lights when the drive starts",
    )
    options.add_argument(
        "--cut", type=float, metavar="HZ", help="keep two periods of this frequency from the first movement"
    )
    options.add_argument(
        "--periods", type=float, default=2.0, help="periods to keep with --cut (default: %(default)g)"
    )
    options.add_argument("--model", help="model named in the recording's header")
    return options


def _point(text: str) -> tuple[float, float]:
    """A point X,Y of the command line [px]."""
    x, _, y = text.partition(",")
    return float(x), float(y)


def _region(text: str) -> tuple[int, int, int, int]:
    """A region X,Y,WIDTH,HEIGHT of the command line [px]."""
    values = [int(part) for part in text.split(",")]
    if len(values) != 4 or min(values) < 0:
        raise argparse.ArgumentTypeError(f"'{text}' is not a region X,Y,WIDTH,HEIGHT in pixels")
    left, top, width, height = values
    return left, top, width, height


def _box(text: str) -> tuple[int, int, int, int]:
    values = [int(part) for part in text.split(",")]
    if len(values) != 4 or min(values[2:]) < 4:
        raise argparse.ArgumentTypeError(f"'{text}' is not a box X,Y,WIDTH,HEIGHT in pixels")
    left, top, width, height = values
    return left, top, width, height
