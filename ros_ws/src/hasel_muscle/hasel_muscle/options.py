"""The options of `bench_muscle`, without anything that takes time to import."""

import argparse
from pathlib import Path

from hasel_recording.command_line import RecordingsParser, add_map_option
from hasel_sysid.command_line.options import names, numbers


def bench_muscle_parser() -> argparse.ArgumentParser:
    """Options of `bench_muscle`."""
    options = RecordingsParser(
        prog="bench_muscle",
        description="Compare one muscle's stroke and force with the law of the Peano-HASEL, see where it fails, learn "
        "what it lacks, add that. Recordings: .csv (time_s, voltage_v, contraction_mm, load_n, current_ma) or .mat.",
    )
    add = options.add_argument
    add("recordings", metavar="RECORDING", nargs="+", type=Path, help=".csv or .mat file of a bench")
    add(
        "--validate",
        metavar="RECORDING",
        nargs="+",
        type=Path,
        default=[],
        help="recordings that are never fitted",
    )
    add_map_option(options, "such as time=t,voltage=U_kV,contraction=x_mm,load=F; #2 is the second column")
    add(
        "--unseen-voltages",
        metavar="V,V",
        type=numbers,
        default=(),
        help="lifts at these voltages are never fitted, and judged",
    )
    add("--muscle", metavar="NAME|FILE", help="the muscle (default: as described beside the recordings)")
    add("--effects", metavar="A,B", type=names, default=(), help="consider only these effects of a muscle")
    add(
        "--fit-only",
        action="store_true",
        help="fit (with --effects: with these), but look for nothing missing",
    )
    add(
        "--settling",
        metavar="S",
        type=_seconds,
        default=1.0,
        help="a frame counts when the voltage was constant for so many seconds (default: %(default)s)",
    )
    add("--all", action="store_true", help="print what is said of every effect")
    add(
        "--output",
        metavar="DIR",
        type=Path,
        default=Path(),
        help="folder for what is written (default: here)",
    )
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
