# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The driver alone: `ros2 launch hasel_driver driver.launch.py port:=/dev/ttyACM0 security:=keys`."""

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction, SetEnvironmentVariable
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

ENCLAVE = "/hasel/driver"  # of security/policy.xml


def _driver(context: LaunchContext) -> list:
    keys = LaunchConfiguration("security").perform(context)
    protected = {
        "ROS_SECURITY_KEYSTORE": keys,
        "ROS_SECURITY_ENABLE": "true",
        "ROS_SECURITY_STRATEGY": "Enforce",
    }
    files = LaunchConfiguration("config").perform(context)
    return [
        *(SetEnvironmentVariable(name, value) for name, value in protected.items() if keys),
        Node(
            package="hasel_driver",
            executable="driver_node",
            namespace=LaunchConfiguration("namespace"),
            parameters=[*([files] if files else []), {"port": LaunchConfiguration("port")}],
            ros_arguments=["--enclave", ENCLAVE] if keys else [],
            output="screen",
        ),
    ]


def generate_launch_description() -> LaunchDescription:
    """One node; with keys, only who has a key is heard."""
    return LaunchDescription(
        [
            DeclareLaunchArgument("namespace", default_value="hasel", description="of topics and services"),
            DeclareLaunchArgument(
                "port", default_value="/dev/ttyACM0", description="serial port of the supply"
            ),
            DeclareLaunchArgument("config", default_value="", description="a file of parameters"),
            DeclareLaunchArgument(
                "security",
                default_value="",
                description="a key store made of security/policy.xml; empty: no keys",
            ),
            OpaqueFunction(function=_driver),
        ]
    )
