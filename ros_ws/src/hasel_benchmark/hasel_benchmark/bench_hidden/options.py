"""The options of `bench_hidden`, without anything that takes time to import."""

import argparse
from pathlib import Path

PAGE = Path("docs/results/hidden_effects.md")
KINDS = {
    "nothing": "nothing",
    "single": "single",
    "strong": "strong",
    "pairs": "pair",
    "unlisted": "unlisted",
    "set-up": "set_up",
}
"""The kind of a case, by what it is called on the command line."""
DISCRETISATIONS = ("near", "coarse", "converged")


def parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(
        prog="bench_hidden",
        description="Hide effects in a simulated truth, let `improve` look for them, and count. Takes hours; "
        "stop with Ctrl-C and go on with --resume.",
    )
    options.add_argument(
        "--seeds", type=int, default=5, metavar="N", help="per effect (default: %(default)s)"
    )
    options.add_argument(
        "--first-seed",
        type=_seed,
        default=0,
        metavar="N",
        help="with 5 or more, cases that no rule was made on (default: %(default)s)",
    )
    options.add_argument("--effects", default="", metavar="A,B", help="only cases that hide one of these")
    options.add_argument("--only", choices=list(KINDS), help="only cases of this kind")
    options.add_argument(
        "--truth", choices=DISCRETISATIONS, default="near", help="discretisation of the truth"
    )
    options.add_argument("--quick", action="store_true", help="five cases, some minutes")
    options.add_argument(
        "--resume", action="store_true", help="keep what the output folder and the page hold"
    )
    options.add_argument(
        "--output", type=Path, default=Path("output/bench_hidden"), metavar="DIR", help="default: %(default)s"
    )
    options.add_argument("--page", type=Path, metavar="FILE", help=f"default: {PAGE}, in DIR for a part")
    options.add_argument(
        "--against",
        type=Path,
        metavar="PATH",
        help="compare with an earlier search on the same cases: its output folder, or the JSON beside its page",
    )
    options.add_argument("--jobs", type=int, metavar="N", help="cases at once (default: one per core)")
    options.add_argument(
        "--alone",
        action="store_true",
        help="one case after the other, each with all jobs, as `improve` has them",
    )
    options.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster, instead of processes")
    return options


def _seed(text: str) -> int:
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"'{text}' is no seed; give a whole number, 0 or more")
    return int(text)
