# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where `bench_muscle` begins: options are read before anything heavy is imported, so that --help answers at once."""

import argparse
from pathlib import Path
from typing import Any

from hasel_common.command_entry import command
from hasel_recording.command_line import RecordingsParser, add_map_option
from hasel_sysid.command_line.options import names, numbers, run_module


@command
def bench_muscle() -> int:
    """`bench_muscle RECORDING…`."""
    return run_module(bench_muscle_parser, "hasel_muscle.bench_muscle")


def bench_muscle_parser() -> argparse.ArgumentParser:
    """Options of `bench_muscle`."""
    options = RecordingsParser(
        prog="bench_muscle",
        description="Compare one muscle's stroke and force with the law of the Peano-HASEL, see where it fails, learn "
        "what it lacks, add that. Recordings: .csv (time_s, voltage_v, contraction_mm, load_n, current_ma) or .mat.",
    )
    add = options.add_argument
    files: dict[str, Any] = {"metavar": "RECORDING", "nargs": "+", "type": Path}
    add("recordings", **files, help=".csv or .mat file of a bench")
    add("--validate", **files, default=[], help="recordings that are never fitted")
    add_map_option(options, "such as time=t,voltage=U_kV,contraction=x_mm,load=F; #2 is the second column")
    unseen = "lifts at these voltages are never fitted, and judged"
    add("--unseen-voltages", metavar="V,V", type=numbers, default=(), help=unseen)
    add("--muscle", metavar="NAME|FILE", help="the muscle (default: as described beside the recordings)")
    add("--effects", metavar="A,B", type=names, default=(), help="consider only these effects of a muscle")
    fitted = "fit (with --effects: with these), but look for nothing missing"
    add("--fit-only", action="store_true", help=fitted)
    settling = "a frame counts when the voltage was constant for so many seconds (default: %(default)s)"
    add("--settling", metavar="S", type=_seconds, default=1.0, help=settling)
    add("--all", action="store_true", help="print what is said of every effect")
    written = "folder for what is written (default: here)"
    add("--output", metavar="DIR", type=Path, default=Path(), help=written)
    add("--json", metavar="FILE", type=Path, help="write the results for other programs")
    return options


def _seconds(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = -1.0
    if not 0.0 <= number <= 600.0:
        raise argparse.ArgumentTypeError(f"{text!r} is no number of seconds from 0 to 600")
    return number
