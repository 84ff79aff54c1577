"""The options of `demo`, without anything that takes time to import."""

import argparse
from pathlib import Path


def parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(
        prog="demo",
        description="Fit, compare, watch it live, learn what is missing, add it, watch the error fall.",
    )
    options.add_argument(
        "--data",
        type=Path,
        default=Path("data") / "unseen_rig" / "quadratic_drag",
        metavar="DIR",
        help="fit_*.csv and val_*.csv (default: %(default)s)",
    )
    options.add_argument(
        "--body",
        type=Path,
        action="append",
        default=[],
        metavar="DIR",
        help="also the measured bodies in this folder: beam, loaded beam, arm (may be given several times)",
    )
    options.add_argument(
        "--muscle",
        type=Path,
        metavar="DIR",
        help="also the measured muscle in this clone of the public repository MadhavL/PH-HASEL-Python",
    )
    options.add_argument(
        "--fish",
        type=Path,
        metavar="DIR",
        help="also the filmed fish in this clone of the public repository srl-ethz/fishsim",
    )
    options.add_argument(
        "--output", type=Path, default=Path("output") / "demo", metavar="DIR", help="(default: %(default)s)"
    )
    return options
