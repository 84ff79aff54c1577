# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 … list`: names, with types if asked to."""

import argparse
from collections.abc import Callable, Iterable

from rclpy.node import Node
from session import discover

NamesAndTypes = Callable[[Node], Iterable[tuple[str, list[str]]]]


def add_listing(commands, what: str, names_and_types: NamesAndTypes) -> None:
    """Add the command `list` of what is there (topics, services, actions)."""
    listing = commands.add_parser("list", help=f"{what} that are there")
    listing.add_argument("-t", "--show-types", action="store_true")

    def print_names(node: Node, options: argparse.Namespace) -> None:
        discover(node)
        for name, types in sorted(names_and_types(node)):
            print(f"{name} [{', '.join(types)}]" if options.show_types else name)

    listing.set_defaults(run=print_names)
