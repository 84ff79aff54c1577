# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Simulator, identification and a replayed recording: `ros2 launch hasel_bringup replay.launch.py recording:=FILE`."""

from typing import Any

from hasel_bringup.launching import Values, described, node
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

ARGUMENTS = (
    DeclareLaunchArgument("recording", description="the .mcap or .csv file to replay"),
    DeclareLaunchArgument(
        "rate",
        default_value="1",
        description="how many times real time, or max: as fast as the nodes take it",
    ),
    DeclareLaunchArgument(
        "config",
        default_value=PathJoinSubstitution([FindPackageShare("hasel_bringup"), "config", "swimmer.yaml"]),
        description="parameters of the simulator and the identification",
    ),
    DeclareLaunchArgument(
        "model", default_value="", description="name or file of a model, in place of that in config"
    ),
)


def generate_launch_description() -> LaunchDescription:
    """The three nodes; two of them live by the recording's clock."""
    return described(ARGUMENTS, _nodes)


def _nodes(given: Values) -> list[Any]:
    timed = {"model": given["model"], "use_sim_time": True}
    replay = ["--rate", given["rate"], "--clock", "--expect", "hasel_simulator", "hasel_sysid"]
    return [
        node(given, "hasel_sim", "simulator", given["config"], timed),
        node(given, "hasel_sysid", "sysid", given["config"], timed),
        node(given, "hasel_bringup", "replay", arguments=[given["recording"], *replay]),
    ]
