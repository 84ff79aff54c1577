"""The options of `replay`, without anything that takes time to import."""

import argparse
import math


def _rate(text: str) -> float:
    if text == "max":
        return math.inf
    try:
        rate = float(text)
    except ValueError:
        rate = 0.0
    if not 0 < rate < math.inf:
        raise argparse.ArgumentTypeError(f"'{text}' is no rate; expected a number above 0 such as 1, or max")
    return rate


def parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(
        prog="replay",
        description="Publish state and bending/measured from recordings, with their own stamps, in the namespace "
        "/hasel or another (--ros-args -r __ns:=/rig2); "
        "of further recordings: moved to follow 10 s after the one before.",
    )
    options.add_argument("recordings", nargs="+", metavar="RECORDING", help=".mcap or .csv file")
    options.add_argument("--rate", type=_rate, default=1.0, help="times real time, or max (default: 1)")
    options.add_argument(
        "--expect", nargs="*", default=[], metavar="NODE", help="nodes that must listen first"
    )
    options.add_argument(
        "--wait", type=float, default=30.0, help="longest wait for listeners [s] (default: 30)"
    )
    options.add_argument(
        "--clock", action="store_true", help="publish the stamps on /clock, for nodes with use_sim_time"
    )
    return options
