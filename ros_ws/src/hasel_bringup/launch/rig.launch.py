"""The whole stack on the rig, or on a virtual one: `ros2 launch hasel_bringup rig.launch.py virtual:=true`."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description() -> LaunchDescription:
    """Driver and tracker or their virtual counterparts, and with them simulator and identification."""
    virtual, config, rig, namespace = (
        LaunchConfiguration(name) for name in ("virtual", "config", "rig", "namespace")
    )
    folder = [FindPackageShare("hasel_bringup"), "config"]
    arguments = [
        DeclareLaunchArgument(
            "namespace",
            default_value="hasel",
            description="of all topics and services but /diagnostics; another for a second rig",
        ),
        DeclareLaunchArgument(
            "virtual",
            default_value="false",
            description="true: without hardware, a virtual supply and swimmer",
        ),
        DeclareLaunchArgument(
            "hidden",
            default_value="['']",
            description="what the virtual swimmer has beyond the model, such as [quadratic_drag.coefficient=0.25]",
        ),
        DeclareLaunchArgument(
            "config",
            default_value=PathJoinSubstitution([*folder, "swimmer.yaml"]),
            description="parameters of the simulator and the identification",
        ),
        DeclareLaunchArgument(
            "rig",
            default_value=PathJoinSubstitution([*folder, "rig.yaml"]),
            description="parameters of the driver and the tracker",
        ),
        DeclareLaunchArgument(
            "diagnostics",
            default_value="false",
            description="true: gather /diagnostics on /diagnostics_agg (diagnostic_aggregator)",
        ),
    ]
    real, simulated = UnlessCondition(virtual), IfCondition(virtual)
    hidden = {"hidden": LaunchConfiguration("hidden")}

    def node(package: str, executable: str, parameters: list, condition=None) -> Node:
        return Node(
            package=package,
            executable=executable,
            parameters=parameters,
            namespace=namespace,
            condition=condition,
            output="screen",
        )

    return LaunchDescription(
        [
            *arguments,
            node("hasel_driver", "driver_node", [rig], real),
            node("hasel_tracker", "tracker_node", [rig], real),
            node("hasel_bringup", "virtual_rig", [hidden], simulated),
            node("hasel_sim", "simulator", [config]),
            node("hasel_sysid", "sysid", [config]),
            Node(
                package="diagnostic_aggregator",
                executable="aggregator_node",
                name="analyzers",  # as the section of its parameter file
                parameters=[PathJoinSubstitution([*folder, "diagnostics.yaml"])],
                condition=IfCondition(LaunchConfiguration("diagnostics")),
                output="screen",
            ),
        ]
    )
