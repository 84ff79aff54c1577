"""The options of `bench_fits`, without anything that takes time to import."""

import argparse
from pathlib import Path


def parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(
        prog="bench_fits",
        description="Hide every effect that has a place or a time, at five sizes over its plausible range, and look "
        "whether `fit` with that effect ends as likely as the truth. Takes half an hour or more.",
    )
    options.add_argument("--effects", type=_names, metavar="A,B", help="only these effects")
    options.add_argument("--seed", type=int, default=0, metavar="N", help="default: %(default)s")
    options.add_argument("--jobs", type=int, metavar="N", help="simulations at once (default: one per core)")
    options.add_argument("--json", type=Path, metavar="FILE", help="write the outcomes")
    return options


def _names(text: str) -> tuple[str, ...]:
    return tuple(text.split(","))
