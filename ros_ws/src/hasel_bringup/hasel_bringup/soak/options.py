"""The options of `soak`, without anything that takes time to import."""

import argparse
from pathlib import Path


def parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(
        prog="soak",
        description="The virtual rig for ten minutes, each node killed and started again in the middle.",
    )
    options.add_argument("--minutes", type=float, default=10.0, help="(default: %(default)g)")
    options.add_argument(
        "--output",
        type=Path,
        default=Path("output") / "soak",
        metavar="DIR",
        help="of the nodes' output (default: %(default)s)",
    )
    return options
