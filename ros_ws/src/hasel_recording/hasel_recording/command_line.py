"""The commands `convert` and `info`."""

import argparse
import sys
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path

from hasel_common.command_entry import command

from hasel_recording.convert import convert
from hasel_recording.errors import RecordingError, RecordingWarning
from hasel_recording.reading import drive_of_each, read_recording
from hasel_recording.reading_options import RecordingsParser, add_reading_options
from hasel_recording.recording import Recording


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
