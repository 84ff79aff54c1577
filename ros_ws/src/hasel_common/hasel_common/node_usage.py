"""`--help` of a node, answered before anything is started."""

import argparse
import sys
from collections.abc import Iterable, Sequence


def user_arguments(arguments: Sequence[str]) -> list[str]:
    """The arguments that are not meant for ROS: all but those from `--ros-args` to `--` or the end."""
    kept: list[str] = []
    for_ros = False
    for argument in arguments:
        if argument == "--ros-args":
            for_ros = True
        elif for_ros and argument == "--":
            for_ros = False
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
    rows = [(f"{key}:={_written(default)}", meaning) for key, default, meaning in parameters]
    width = min(36, max((len(row[0]) for row in rows), default=0))
    listed = "\n".join(f"  {given:{width}}  {meaning}" for given, meaning in rows)
    return f"parameters and their defaults:\n{listed}"


def _written(default: object) -> str:
    if isinstance(default, (list, tuple)):
        return "[" + ", ".join(str(item) for item in default if item != "") + "]"
    return str(default).lower() if isinstance(default, bool) else str(default)
