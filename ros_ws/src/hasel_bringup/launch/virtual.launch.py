# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The live loop without hardware: `ros2 launch hasel_bringup virtual.launch.py hidden:=random`."""

import os
import tempfile
from pathlib import Path
from typing import Any

from hasel_bringup.launching import Values, autostart, described, managed, node, words
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, RegisterEventHandler
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

_LATER = "nice -n 5"  # supply and driver stop themselves when they are held up
ARGUMENTS = (
    DeclareLaunchArgument(
        "lifecycle_manager",
        default_value="true",
        description="true: nodes go up in order, and the driver down when another ends; false: each by itself",
    ),
    DeclareLaunchArgument(
        "hidden",
        default_value="random",
        description="beyond the model: none, random, effects, or values [quadratic_drag.coefficient=0.25]",
    ),
    DeclareLaunchArgument(
        "config",
        default_value=PathJoinSubstitution([FindPackageShare("hasel_bringup"), "config", "virtual.yaml"]),
        description="parameters of all nodes",
    ),
    DeclareLaunchArgument(
        "output",
        default_value=str(Path("output") / "live_demo"),
        description="folder of recordings and results",
    ),
    DeclareLaunchArgument(
        "experiment",
        default_value="true",
        description="true: the whole loop by itself, then all ends; false: the nodes only, for you to use",
    ),
)


def generate_launch_description() -> LaunchDescription:
    """Virtual supply, driver, camera, tracker, simulator, identification, recorder, and who experiments with them."""
    return described(ARGUMENTS, _nodes)


def _nodes(given: Values) -> list[Any]:
    config, output = given["config"], Path(given["output"])
    beside = str(output.parent)  # a folder in use already gets a number
    port = str(Path(tempfile.gettempdir()) / f"hasel_supply_{os.getpid()}")
    supply = {
        "port": port,
        "history_file": f"{port}_history.jsonl",
        "state_folder": f"{port}_state",
        "recording_directory": beside,
    }
    start = autostart(given)
    hidden = {"hidden": words(given["hidden"])}
    nodes = [
        node(given, "hasel_driver", "virtual_supply", arguments=["--link", port]),
        node(given, "hasel_driver", "driver_node", config, supply | start),
        node(given, "hasel_bringup", "virtual_camera", config, hidden, prefix=_LATER),
        node(given, "hasel_tracker", "tracker_node", config, start, prefix=_LATER),
        node(given, "hasel_sim", "simulator", config, {"own_files": beside} | start, prefix=_LATER),
        node(given, "hasel_sysid", "sysid", config, start, prefix=_LATER),
        node(
            given, "hasel_bringup", "recorder", {"folder": str(output / "recordings")} | start, prefix=_LATER
        ),
        *managed(given, "hasel_driver", "hasel_tracker", "hasel_simulator", "hasel_sysid", "hasel_recorder"),
    ]
    if given["experiment"] == "true":
        experimenter = node(
            given, "hasel_bringup", "live_demo", arguments=["--attach", "--output", str(output)]
        )
        ended = OnProcessExit(target_action=experimenter, on_exit=[EmitEvent(event=Shutdown())])
        nodes += [experimenter, RegisterEventHandler(ended)]
    return nodes
