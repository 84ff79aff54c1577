# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What the launch files share: arguments, and a node with its name in the log, its log level and its clock."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

Values = Mapping[str, str]
CLOCK = "use_sim_time"
SHARED = (
    DeclareLaunchArgument(
        "namespace",
        default_value="hasel",
        description="of all topics and services but /diagnostics and /clock; another for a second rig",
    ),
    DeclareLaunchArgument(
        "log_level", default_value="info", description="of all nodes: debug, info, warn, error"
    ),
)


def described(
    arguments: Sequence[DeclareLaunchArgument], entities: Callable[[Values], list[Any]]
) -> LaunchDescription:
    """A description with these and the shared arguments; `entities` makes what is launched of their values."""
    names = [argument.name for argument in (*SHARED, *arguments)]

    def made(context: LaunchContext) -> list[Any]:
        return entities({name: LaunchConfiguration(name).perform(context) for name in names})

    return LaunchDescription([*SHARED, *arguments, OpaqueFunction(function=made)])


def words(text: str) -> list[str]:
    """Of an argument that is one word, or several with commas, in brackets or not."""
    return [word.strip() for word in text.strip("[]").split(",")]


def managed(values: Values, *names: str) -> list[Node]:
    """The manager of the nodes of these names, the driver first, where the argument asks for one; see `autostart`."""
    if values["lifecycle_manager"] != "true":
        return []
    return [node(values, "hasel_bringup", "lifecycle_manager", {"nodes": list(names)})]


def autostart(values: Values) -> dict[str, bool]:
    """The parameter of nodes that a manager brings up, or that start by themselves."""
    return {"autostart": values["lifecycle_manager"] != "true"}


def node(
    values: Values, package: str, executable: str, *parameters: str | Mapping[str, Any], **options: Any
) -> Node:
    """An executable of ours; parameters: files, and values of which the empty ones are left to the files."""
    given = [
        each if isinstance(each, str) else {name: value for name, value in each.items() if value != ""}
        for each in parameters
    ]
    return Node(
        package=package,
        executable=executable,
        exec_name=executable,
        namespace=values["namespace"],
        parameters=[each for each in given if each],
        ros_arguments=["--log-level", values["log_level"]],
        output="screen",
        **options,
    )
