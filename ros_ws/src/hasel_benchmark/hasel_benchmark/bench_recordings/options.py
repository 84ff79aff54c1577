"""The options of `bench_recordings`, without anything that takes time to import."""

import argparse
from pathlib import Path

NUMBERS = (10, 30, 100)


def parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(
        prog="bench_recordings",
        description="Time `improve` for more and more recordings of one truth with a hidden effect: by the clock, in "
        "processor time, and how much memory all its processes take at once. Takes about ten minutes.",
    )
    options.add_argument(
        "--numbers",
        type=int,
        nargs="+",
        default=NUMBERS,
        metavar="N",
        help="of recordings, up to 102 (default: 10 30 100)",
    )
    options.add_argument("--jobs", type=int, metavar="N", help="processes (default: one per core)")
    options.add_argument("--json", type=Path, metavar="FILE", help="write the figures")
    return options
