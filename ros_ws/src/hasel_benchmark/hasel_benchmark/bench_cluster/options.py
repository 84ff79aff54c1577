"""The options of `bench_cluster`, without anything that takes time to import."""

import argparse
from pathlib import Path

RECORDINGS = Path("data") / "unseen_rig" / "quadratic_drag"


def parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(
        prog="bench_cluster",
        description="Start Dask workers on this machine and time `improve` and `swim` with --scheduler, two workers "
        "against one in turns; the answers must be those of one process without a cluster, to the last digit. Takes "
        "about ten minutes.",
    )
    options.add_argument(
        "--recordings",
        type=Path,
        default=RECORDINGS,
        metavar="DIR",
        help="with fit_*.csv and val_*.csv (default: %(default)s)",
    )
    options.add_argument(
        "--rounds",
        type=int,
        default=3,
        metavar="N",
        help="of each, the middle one counts (default: %(default)s)",
    )
    options.add_argument("--json", type=Path, metavar="FILE", help="write the times")
    return options
