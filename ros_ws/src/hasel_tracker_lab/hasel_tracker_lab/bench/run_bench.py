"""`bench`: accuracy, speed and robustness of the tracker against rendered truth, beside the bars."""

import argparse
import json
import sys
from collections.abc import Sequence

from hasel_tracker.commands.command import run_command
from hasel_tracker.errors import TrackerError
from rich.console import Console

from hasel_tracker_lab.bench.tracker_report import run_bench
from hasel_tracker_lab.tracker_lab_commands import bench_parser

LEAST_FRAMES = 30


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return run(bench_parser().parse_args(arguments))


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code: 0 if every bar is met, 2 if not."""
    missed: list[str] = []
    return run_command(lambda: _bench(options, missed)) or (2 if missed else 0)


def _bench(options: argparse.Namespace, missed: list[str]) -> None:
    if options.frames < LEAST_FRAMES:
        raise TrackerError(f"{options.frames} frames are too few; give at least {LEAST_FRAMES}.")
    progress = Console(stderr=True)
    report = run_bench(options.frames, lambda sentence: progress.print(sentence, style="dim"))
    report.print(Console(width=110))
    if options.json is not None:
        options.json.write_text(json.dumps(report.values(), indent=1))
    missed.extend(bar.what for bar in report.bars() if not bar.met)


if __name__ == "__main__":
    sys.exit(main())
