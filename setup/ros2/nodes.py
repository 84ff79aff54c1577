# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 node list`."""

import argparse

from rclpy.node import Node
from session import discover


def add_parsers(commands) -> None:
    """Add what `ros2 node` knows."""
    commands.add_parser("list", help="nodes that are there").set_defaults(run=list_nodes)


def list_nodes(node: Node, _: argparse.Namespace) -> None:
    """Print the full names of all but this one."""
    discover(node)
    names = {f"{space.rstrip('/')}/{name}" for name, space in node.get_node_names_and_namespaces()}
    print("\n".join(sorted(names - {node.get_fully_qualified_name()})))
