# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A node's parameters, known without ROS: for `--help`, the READMEs' tables and the core's own checks."""

import argparse
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

AUTOSTART = "autostart", True, "configure and activate at the start; false: wait for the lifecycle's services"
"""Of every node with a lifecycle: name, default and meaning."""


@dataclass(frozen=True)
class NodeParameter:
    """A number has a unit and a range from `low` to `high`, a text may have `choices`.

    Only a `changeable` one can be set while the node runs.
    """

    name: str
    default: Any
    description: str
    unit: str = ""
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    changeable: bool = False

    def __post_init__(self) -> None:
        if (self.low is None) != (self.high is None):
            raise ValueError(
                f"{self.name} has one end of a range, both or none were expected: give low and high."
            )

    @property
    def span(self) -> tuple[float, float] | None:
        """Lowest and highest value; None where any will do."""
        return None if self.low is None or self.high is None else (self.low, self.high)

    @property
    def usage(self) -> tuple[str, Any, str]:
        """Name, default and meaning with unit and range, for `--help`."""
        span = "" if self.low is None else f", {self.low:g} to {self.high:g}"
        unit = f" [{self.unit}{span}]" if self.unit else ""
        return self.name, self.default, self.description + unit


def user_arguments(arguments: Sequence[str]) -> list[str]:
    """The arguments that are not meant for ROS: all but those from `--ros-args` to `--` or the end."""
    kept, for_ros = [], False
    for argument in arguments:
        if argument == "--ros-args" or (for_ros and argument == "--"):
            for_ros = argument == "--ros-args"
        elif not for_ros:
            kept.append(argument)
    return kept


def answer_help(
    name: str,
    description: str,
    parameters: Iterable[tuple[str, object, str]],
    arguments: Sequence[str] | None = None,
) -> None:
    """Print usage and leave with exit code 0 where --help is asked for, with 2 after an argument that is unknown.

    parameters: name, default and meaning of each; arguments: default those of this process.
    """
    parser = argparse.ArgumentParser(
        prog=name,
        usage=f"{name} [--help] [--ros-args -p PARAMETER:=VALUE …]",
        description=description,
        epilog=parameter_list(parameters),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.parse_args(user_arguments(sys.argv[1:] if arguments is None else arguments))


def parameter_list(parameters: Iterable[tuple[str, object, str]]) -> str:
    """A node's parameters, one a line: name with default, meaning."""

    def written(default: object) -> str:
        if isinstance(default, (list, tuple)):
            return "[" + ", ".join(str(item) for item in default if item != "") + "]"
        return str(default).lower() if isinstance(default, bool) else str(default)

    rows = [(f"{key}:={written(default)}", meaning) for key, default, meaning in parameters]
    width = min(36, max((len(row[0]) for row in rows), default=0))
    listed = "\n".join(f"  {given:{width}}  {meaning}" for given, meaning in rows)
    return f"parameters and their defaults:\n{listed}"
