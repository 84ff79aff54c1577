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
    ]
    real, simulated = UnlessCondition(virtual), IfCondition(virtual)
    return LaunchDescription(
        [
            *arguments,
            Node(
                package="hasel_driver",
                executable="driver_node",
                parameters=[rig],
                namespace=namespace,
                condition=real,
                output="screen",
            ),
            Node(
                package="hasel_tracker",
                executable="tracker_node",
                parameters=[rig],
                namespace=namespace,
                condition=real,
                output="screen",
            ),
            Node(
                package="hasel_bringup",
                executable="virtual_rig",
                parameters=[{"hidden": LaunchConfiguration("hidden")}],
                namespace=namespace,
                condition=simulated,
                output="screen",
            ),
            Node(
                package="hasel_sim",
                executable="simulator",
                parameters=[config],
                namespace=namespace,
                output="screen",
            ),
            Node(
                package="hasel_sysid",
                executable="sysid",
                parameters=[config],
                namespace=namespace,
                output="screen",
            ),
        ]
    )
