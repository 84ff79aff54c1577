"""The live loop without hardware: `ros2 launch hasel_bringup virtual.launch.py hidden:=random`."""

import os
import tempfile
from pathlib import Path

from hasel_bringup.live_demo.nodes import TRACKER
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, RegisterEventHandler
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node

_LATER = "nice -n 5"  # supply and driver stop themselves when they are held up


def generate_launch_description() -> LaunchDescription:
    """Virtual supply, driver, camera, tracker, simulator, identification, recorder, and who experiments with them."""
    namespace, hidden, output = (LaunchConfiguration(name) for name in ("namespace", "hidden", "output"))
    arguments = [
        DeclareLaunchArgument(
            "namespace", default_value="hasel", description="of all topics and services but /diagnostics"
        ),
        DeclareLaunchArgument(
            "hidden",
            default_value="random",
            description="what the swimmer has beyond the model: an effect's id, random or none",
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
    ]
    port = str(Path(tempfile.gettempdir()) / f"hasel_supply_{os.getpid()}")
    own = {"history_file": f"{port}_history.jsonl", "state_folder": f"{port}_state"}
    beside = PathJoinSubstitution([output, ".."])  # a folder in use already gets a number
    supply = {"port": port, "recorded_topics": [""], "recording_directory": beside, **own}
    folder = {"folder": PathJoinSubstitution([output, "recordings"])}

    def node(package: str, executable: str, *parameters: dict, **options) -> Node:
        return Node(
            package=package,
            executable=executable,
            namespace=namespace,
            parameters=list(parameters),
            output="screen",
            **options,
        )

    experimenter = node(
        "hasel_bringup",
        "live_demo",
        arguments=["--attach", "--output", output],
        condition=IfCondition(LaunchConfiguration("experiment")),
    )
    return LaunchDescription(
        [
            *arguments,
            node("hasel_driver", "virtual_supply", arguments=["--link", port]),
            node("hasel_driver", "driver_node", supply),
            node("hasel_bringup", "virtual_camera", {"hidden": hidden}, prefix=_LATER),
            node("hasel_tracker", "tracker_node", TRACKER, prefix=_LATER),
            node("hasel_sim", "simulator", {"own_files": beside}, prefix=_LATER),
            node("hasel_sysid", "sysid", prefix=_LATER),
            node("hasel_bringup", "recorder", folder, prefix=_LATER),
            experimenter,
            RegisterEventHandler(
                OnProcessExit(target_action=experimenter, on_exit=[EmitEvent(event=Shutdown())])
            ),
        ]
    )
