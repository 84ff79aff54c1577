"""The options of `bench`, without anything that takes time to import."""

import argparse
from collections.abc import Sequence
from pathlib import Path


def options_from(arguments: Sequence[str] | None = None) -> argparse.Namespace:
    """What the command line says; leaves with exit code 2 where it cannot be done."""
    parser = argparse.ArgumentParser(
        prog="bench",
        description="How fast a command reaches the wire, how fast a dead node is grounded, and how many experiments"
        " end by a fault although nothing is wrong but that the machine is busy.",
    )
    parser.add_argument("--commands", type=int, default=1000, help="commands for the latency")
    parser.add_argument("--kills", type=int, default=5, help="nodes to be killed")
    parser.add_argument("--experiments", type=int, default=0, help="of three seconds each, to be counted")
    parser.add_argument("--realtime-priority", type=int, default=40, help="the node's parameter; 0: none")
    parser.add_argument(
        "--firmware",
        type=Path,
        metavar="BUILD",
        help="folder in which `make -C firmware all simulator` built sketch and simulator: measure these, end to end,"
        " with the serial line's own speed, instead of the virtual supply",
    )
    options = parser.parse_args(arguments)
    if options.firmware is not None and not all(file.is_file() for file in firmware_files(options.firmware)):
        parser.error(f"{options.firmware} holds no simulate and hasel_supply.elf: build them with make first")
    return options


def firmware_files(build: Path) -> tuple[Path, Path]:
    """Simulator and sketch within the folder of a build."""
    return build / "simulate", build / "hasel_supply.elf"
