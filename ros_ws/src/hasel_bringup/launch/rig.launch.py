# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The whole stack on the rig, or on a virtual one: `ros2 launch hasel_bringup rig.launch.py virtual:=true`."""

from typing import Any

from hasel_bringup.launching import Values, autostart, described, managed, node, words
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

CONFIG = [FindPackageShare("hasel_bringup"), "config"]
ARGUMENTS = (
    DeclareLaunchArgument(
        "lifecycle_manager",
        default_value="true",
        description="true: nodes go up in order, and the driver down when another ends; false: each by itself",
    ),
    DeclareLaunchArgument(
        "virtual", default_value="false", description="true: without hardware, a virtual supply and swimmer"
    ),
    DeclareLaunchArgument(
        "hidden",
        default_value="none",
        description="beyond the model: none, random, effects, or values [quadratic_drag.coefficient=0.25]",
    ),
    DeclareLaunchArgument(
        "config",
        default_value=PathJoinSubstitution([*CONFIG, "swimmer.yaml"]),
        description="parameters of the simulator and the identification",
    ),
    DeclareLaunchArgument(
        "rig",
        default_value=PathJoinSubstitution([*CONFIG, "rig.yaml"]),
        description="parameters of the driver and the tracker",
    ),
    DeclareLaunchArgument(
        "model", default_value="", description="name or file of a model, in place of that in config"
    ),
    DeclareLaunchArgument(
        "port", default_value="", description="serial port of the supply, in place of that in rig"
    ),
    DeclareLaunchArgument(
        "source", default_value="", description="camera, video or topic, in place of that in rig"
    ),
    DeclareLaunchArgument(
        "use_sim_time", default_value="false", description="true: the nodes live by the topic /clock"
    ),
    DeclareLaunchArgument(
        "diagnostics",
        default_value="false",
        description="true: gather /diagnostics on /diagnostics_agg (diagnostic_aggregator)",
    ),
)


def generate_launch_description() -> LaunchDescription:
    """Driver and tracker or their virtual counterparts, and with them simulator and identification."""
    return described(ARGUMENTS, _nodes)


def _nodes(given: Values) -> list[Any]:
    start = autostart(given)
    model = {"model": given["model"], "use_sim_time": given["use_sim_time"] == "true"}
    if given["virtual"] == "true":
        names = ["hasel_driver"]  # which the virtual rig starts itself
        body = [node(given, "hasel_bringup", "virtual_rig", {"hidden": words(given["hidden"])})]
    else:
        names = ["hasel_driver", "hasel_tracker"]
        body = [
            node(given, "hasel_driver", "driver_node", given["rig"], {"port": given["port"], **start}),
            node(given, "hasel_tracker", "tracker_node", given["rig"], {"source": given["source"], **start}),
        ]
    gathered = Node(
        package="diagnostic_aggregator",
        executable="aggregator_node",
        name="analyzers",  # as the section of its parameter file
        parameters=[PathJoinSubstitution([*CONFIG, "diagnostics.yaml"])],
        output="screen",
    )
    return [
        *body,
        node(given, "hasel_sim", "simulator", given["config"], model | start),
        node(given, "hasel_sysid", "sysid", given["config"], model | start),
        *managed(given, *names, "hasel_simulator", "hasel_sysid"),
        *([gathered] if given["diagnostics"] == "true" else []),
    ]
