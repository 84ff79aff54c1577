"""The options of `bench_far`, without anything that takes time to import."""

import argparse
from pathlib import Path

from hasel_benchmark.bench_far.constants_far_off import BODIES, SHIFTS, SIZES


def parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(
        prog="bench_far",
        description="Set a gross constant of a truth so that it rings 10 to 60 % faster or slower, and look whether "
        "`improve` names it. Takes an hour or more.",
    )
    options.add_argument(
        "--effects", type=_list_of(str), default=tuple(SIZES), metavar="A,B", help="hidden ones"
    )
    options.add_argument(
        "--shifts", type=_list_of(float), default=SHIFTS, metavar="S,T", help="such as -0.4,0.25"
    )
    options.add_argument("--body", choices=BODIES, help="only this body")
    options.add_argument("--candidates", type=_list_of(str), metavar="A,B", help="try only these effects")
    options.add_argument("--jobs", type=int, metavar="N", help="simulations at once (default: one per core)")
    options.add_argument("--json", type=Path, metavar="FILE", help="write the outcomes")
    return options


def _list_of(kind: type):
    return lambda text: tuple(kind(part) for part in text.split(","))
