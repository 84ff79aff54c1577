# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The part of `ros2` that the README uses, for where ROS 2 comes as wheels, which bring no command line."""

import argparse
import sys

import action
import nodes
import param
import service
import topic
from messages import NotUnderstoodError
from session import session

_COMMANDS = {"topic": topic, "service": service, "action": action, "param": param, "node": nodes}


def parser() -> argparse.ArgumentParser:
    """All commands with their options."""
    whole = argparse.ArgumentParser(
        prog="ros2",
        description="The part of the ROS 2 command line that this project's README uses; `ros2 run PACKAGE EXECUTABLE` "
        "starts an executable. Where ROS 2 itself is installed, its own ros2 answers instead.",
    )
    commands = whole.add_subparsers(metavar="COMMAND", required=True)
    commands.add_parser("run", help="start an executable of a package", add_help=False)
    for name, module in _COMMANDS.items():
        verbs = commands.add_parser(name, help=module.__doc__.strip("`.\n").replace("`", ""))
        module.add_parsers(verbs.add_subparsers(metavar="VERB", required=True))
    return whole


def main(arguments: list[str]) -> int:
    """Run one command; returns its exit code."""
    options = parser().parse_args(arguments)
    try:
        with session() as node:
            options.run(node, options)
    except NotUnderstoodError as error:
        print(error, file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
