"""Laws that cannot be compiled run as Python; whoever waits for them is told once."""

import sys
from collections.abc import Mapping

_said: set[str] = set()


def say_once(laws: Mapping[str, str], factor: float) -> None:
    """One line for each that was not named before in this process.

    laws: names of effects, with why they are not compiled; factor: how many times as long a step takes with them.
    """
    for name, why in laws.items():
        if name not in _said:
            _said.add(name)
            print(
                f"hasel_sim: effect '{name}' runs as Python, and steps take {factor:.1f} times as long: {why}",
                file=sys.stderr,
                flush=True,
            )
