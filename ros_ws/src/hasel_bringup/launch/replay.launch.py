"""Simulator, identification and a replayed recording: `ros2 launch hasel_bringup replay.launch.py recording:=FILE`."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description() -> LaunchDescription:
    """The three nodes."""
    config = LaunchConfiguration("config")
    namespace = LaunchConfiguration("namespace")
    timed = [config, {"use_sim_time": True}]
    arguments = [
        DeclareLaunchArgument(
            "namespace",
            default_value="hasel",
            description="of all topics and services but /diagnostics and /clock",
        ),
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
    ]
    replay = ["--rate", LaunchConfiguration("rate"), "--clock", "--expect", "hasel_simulator", "hasel_sysid"]
    return LaunchDescription(
        [
            *arguments,
            Node(
                package="hasel_sim",
                executable="simulator",
                namespace=namespace,
                parameters=timed,
                output="screen",
            ),
            Node(
                package="hasel_sysid",
                executable="sysid",
                namespace=namespace,
                parameters=timed,
                output="screen",
            ),
            Node(
                package="hasel_bringup",
                executable="replay",
                namespace=namespace,
                arguments=[LaunchConfiguration("recording"), *replay],
                output="screen",
            ),
        ]
    )
