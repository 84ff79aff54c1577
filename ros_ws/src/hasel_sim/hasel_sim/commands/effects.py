"""List the physical effects, or print what one of them states."""

import argparse
import sys
from collections.abc import Sequence

from hasel_sim.commands.parsers import effects_parser
from hasel_sim.effects.card import card, document, overview
from hasel_sim.effects.registry import catalogue, find_effects
from hasel_sim.errors import HaselSimError


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return run(effects_parser().parse_args(arguments))


def run(options: argparse.Namespace) -> int:
    """Print what was asked for; returns the exit code."""
    try:
        if options.table:
            print(document(catalogue().values()), end="")
        elif options.names:
            print("\n\n".join(card(effect) for effect in find_effects(tuple(options.names))))
        else:
            print(overview(catalogue().values()))
    except HaselSimError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
