"""The options of `measured_fish`, without anything that takes time to import."""

import argparse
from pathlib import Path


def measured_fish_parser() -> argparse.ArgumentParser:
    """Options of `measured_fish`."""
    options = argparse.ArgumentParser(
        prog="measured_fish",
        description="Compare the speeds of a filmed robot fish, of the public repository srl-ethz/fishsim, with those "
        "that the forces of the fluid give it for how its tail beats, and check its drive.",
    )
    add = options.add_argument
    add("folder", metavar="DIR", type=Path, help="a clone of the repository, or its folder of markers")
    add(
        "--fitted",
        metavar="HZ,HZ",
        type=numbers,
        default=(1.0, 1.75),
        help="films, by the frequency in their name, that the drag of the head is fitted to (default: 1,1.75)",
    )
    add(
        "--output",
        metavar="DIR",
        type=Path,
        default=Path("measured_fish"),
        help="folder for what is written (default: measured_fish)",
    )
    add("--json", metavar="FILE", type=Path, help="write the results for other programs")
    return options


def names(text: str) -> tuple[str, ...]:
    """Words with commas between them."""
    return tuple(name.strip() for name in text.split(",") if name.strip())


def numbers(text: str) -> tuple[float, ...]:
    """Numbers with commas between them. Raises ArgumentTypeError for another text."""
    try:
        return tuple(float(number) for number in names(text))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no list of voltages, such as 2000,4000") from None
