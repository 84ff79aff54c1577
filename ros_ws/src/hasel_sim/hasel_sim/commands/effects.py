"""List the physical effects, or print what one of them states."""

import argparse
import sys
from collections.abc import Sequence

from hasel_sim.effects.card import card, document, overview
from hasel_sim.effects.registry import catalogue, find_effects
from hasel_sim.errors import HaselSimError


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="effects", description="List the physical effects that a model can have, or print one's card."
    )
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help="an effect's id, or path/to/file.py:ClassName of your own"
    )
    parser.add_argument("--table", action="store_true", help="print all of them as the documentation's page")
    options = parser.parse_args(arguments)
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
