"""The options with which a command reads recordings that are not called as expected."""

import argparse
from pathlib import Path
from typing import NoReturn

from hasel_recording.column_map import parse_map
from hasel_recording.errors import RecordingError


class RecordingsParser(argparse.ArgumentParser):
    """A parser that says so where an option that takes several files has taken the recordings too."""

    def error(self, message: str) -> NoReturn:
        """Leave with usage, the message and a remedy."""
        if "required: RECORDING" in message:
            message += (
                " (an option such as --drive takes every file that follows it: name the recordings first)"
            )
        super().error(message)


def add_reading_options(parser: argparse.ArgumentParser) -> None:
    """Add --map and --drive."""
    add_map_option(
        parser,
        "such as time=t,sin_theta=angle_deg,voltage_upper=U1_kV; #2 is the second column, drive.time the time in the "
        "drive's own file",
    )
    parser.add_argument(
        "--drive",
        metavar="FILE",
        nargs="+",
        type=Path,
        default=[],
        help="the drive as a file of its own: one for each recording in their order, or one for all",
    )


def add_map_option(parser: argparse.ArgumentParser, example: str) -> None:
    """Add --map."""
    parser.add_argument(
        "--map",
        metavar="NAME=COLUMN,…",
        action=_Mapping,
        default={},
        help=f"names and units of your own CSV columns, {example}; may be given several times",
    )


class _Mapping(argparse.Action):
    """Collects the pairs of every --map."""

    def __call__(self, parser, namespace, values, option_string=None) -> None:
        """Add the pairs of one --map."""
        try:
            setattr(namespace, self.dest, {**getattr(namespace, self.dest), **parse_map(values)})
        except RecordingError as error:
            raise argparse.ArgumentError(self, str(error)) from None
