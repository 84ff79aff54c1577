"""The options with which a command reads recordings that are not called as expected."""

import argparse
from pathlib import Path

from hasel_recording.column_map import parse_map
from hasel_recording.errors import RecordingError


def add_reading_options(parser: argparse.ArgumentParser) -> None:
    """Add --map and --drive."""
    parser.add_argument(
        "--map",
        metavar="NAME=COLUMN,…",
        type=_mapping,
        default={},
        help="names and units of your own CSV columns, such as time=t,sin_theta=angle_deg,voltage_upper=U1_kV",
    )
    parser.add_argument(
        "--drive",
        metavar="FILE",
        nargs="+",
        type=Path,
        default=[],
        help="the drive as a file of its own: one for each recording in their order, or one for all",
    )


def _mapping(text: str) -> dict[str, str]:
    try:
        return parse_map(text)
    except RecordingError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
