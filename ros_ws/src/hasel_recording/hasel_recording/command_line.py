# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The commands `convert` and `info`, and the options with which every command reads recordings."""

import argparse
import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn

from hasel_common.command_entry import command

from hasel_recording.csv_columns import parse_map
from hasel_recording.csv_run import drive_path
from hasel_recording.csv_text import TEXT_SUFFIXES
from hasel_recording.errors import RecordingError, RecordingWarning
from hasel_recording.reading import WRITERS, drive_of_each, read_recording, write_recording
from hasel_recording.recording import Recording

OTHER_SUFFIX = dict.fromkeys(TEXT_SUFFIXES, ".mcap") | {".mcap": ".csv", ".db3": ".csv"}


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

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,
    ) -> None:
        """Add the pairs of one --map."""
        try:
            setattr(namespace, self.dest, {**getattr(namespace, self.dest), **parse_map(values)})
        except RecordingError as error:
            raise argparse.ArgumentError(self, str(error)) from None


def target_path(source: Path, output: Path | None = None) -> Path:
    """Return where a conversion goes: `output` when it is a file name, else the source's name in that folder.

    Without output the new file lies beside the source.
    """
    if output is not None and output.suffix.lower() in WRITERS:
        return output
    suffix = OTHER_SUFFIX.get(source.suffix.lower(), ".csv")  # a rosbag2 folder has no suffix
    folder = source.parent if output is None else output
    return folder / (source.stem + suffix)


def convert(
    source: Path,
    output: Path | None = None,
    *,
    replace: bool = False,
    mapping: Mapping[str, str] | None = None,
    drive: str | Path | None = None,
) -> Path:
    """Convert CSV to MCAP or MCAP to CSV and return the new file; raises RecordingError.

    An existing file is replaced only when `replace` is set. mapping, drive: as of read_recording.
    """
    recording = read_recording(source, mapping, drive)
    target = target_path(source, output)
    written = [target]
    if target.suffix.lower() == ".csv" and recording.drive_time_s is not None:
        written.append(drive_path(target))
    for path in written:
        if path.exists() and not replace:
            raise RecordingError(f"{path} exists already: give --force to replace it, or another --output.")
    target.parent.mkdir(parents=True, exist_ok=True)
    write_recording(recording, target)
    return target


@command
def convert_main(arguments: Sequence[str] | None = None) -> int:
    """Convert the recordings named on the command line; return an exit code."""
    parser = RecordingsParser(
        prog="convert",
        description="Turn CSV recordings into MCAP (for rosbag2, Foxglove, PlotJuggler) and MCAP into CSV. "
        "The header lines go along; numbers are kept exactly, times to the nanosecond.",
    )
    parser.add_argument("recordings", metavar="RECORDING", nargs="+", type=Path, help="a .csv or .mcap file")
    parser.add_argument(
        "-o",
        "--output",
        metavar="PATH",
        type=Path,
        help="file or folder to write (default: beside the recording)",
    )
    parser.add_argument("-f", "--force", action="store_true", help="replace files that exist")
    add_reading_options(parser)
    options = parser.parse_args(arguments)
    if len(options.recordings) > 1 and options.output is not None and options.output.suffix:
        parser.error(
            f"--output {options.output} is one file for {len(options.recordings)} recordings: name a folder"
        )

    def work(path: Path, drive: str | Path | None) -> str:
        target = convert(path, options.output, replace=options.force, mapping=options.map, drive=drive)
        return f"{path} -> {target}"

    return _for_each(options, work)


@command
def info_main(arguments: Sequence[str] | None = None) -> int:
    """Describe the recordings named on the command line; return an exit code."""
    parser = RecordingsParser(prog="info", description="Say what a recording holds.")
    parser.add_argument("recordings", metavar="RECORDING", nargs="+", type=Path, help="a .csv or .mcap file")
    add_reading_options(parser)
    options = parser.parse_args(arguments)
    return _for_each(options, lambda path, drive: _description(read_recording(path, options.map, drive)))


def _description(recording: Recording) -> str:
    lines = [str(recording), *(f"    {s}" for s in (*recording.understood, *recording.ripple))]
    lines += [*(f"    {key}: {value}" for key, value in recording.metadata.items())]
    if recording.driven:
        lines.append(f"    driven by {', '.join(map(str, recording.channels))}")
    if recording.markers is not None:
        lines.append(f"    markers {', '.join(recording.marker_names)} in {recording.marker_unit}")
    if recording.drive_time_s is not None:
        lines.append(f"    drive changes at {len(recording.drive_time_s)} instants, not all on frames")
    if recording.simulated_time_s is not None:
        lines.append(f"    simulated angle at {len(recording.simulated_time_s)} instants")
    return "\n".join(lines)


def _for_each(options: argparse.Namespace, work: Callable[[Path, str | Path | None], str]) -> int:
    """Print the work's result for each recording; errors and warnings go to stderr, one line each."""
    try:
        drives = drive_of_each(options.recordings, options.drive)
    except RecordingError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    failed = False
    for path, drive in zip(options.recordings, drives, strict=True):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", RecordingWarning)
            try:
                print(work(path, drive))
            except RecordingError as error:
                failed = True
                print(f"error: {error}", file=sys.stderr)
        for warning in caught:
            print(f"warning: {warning.message}", file=sys.stderr)
    return int(failed)
