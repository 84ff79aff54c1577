# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""How the nodes meet: the quality of service of every topic in one place, and names that a namespace can change.

Every topic is given to ROS relative to the node's namespace, so that two rigs run side by side (`-r __ns:=/rig2`) and
a name can be remapped. Depth, history and reliability can be overridden from outside, as of any ROS 2 node, by the
parameters `qos_overrides.<topic>.publisher.…` and `qos_overrides.<topic>.subscription.…`.
"""

from collections.abc import Callable
from enum import Enum
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions
from rclpy.subscription import Subscription

from hasel_common.topics import relative

_OVERRIDABLE: dict[str, Any] = {"qos_overriding_options": QoSOverridingOptions.with_default_policies()}
STEADY = Clock(clock_type=ClockType.STEADY_TIME)  # goes on while a replay's /clock stands still


class Role(Enum):
    """What a topic is for, and the quality of service that follows from it."""

    COMMANDS = QoSProfile(depth=100, reliability=ReliabilityPolicy.RELIABLE)
    """None may be lost, and the next must not push out a bad one before it was seen."""
    SAMPLES = QoSProfile(depth=200, reliability=ReliabilityPolicy.RELIABLE)
    """From hardware, which never waits for a slow listener: each is compared and recorded."""
    EVERY_SAMPLE = QoSProfile(history=HistoryPolicy.KEEP_ALL, reliability=ReliabilityPolicy.RELIABLE)
    """Where each must arrive: heard by simulator and sysid, sent by what can wait."""
    PICTURES = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    """Only the newest is of use: as `rclpy.qos.qos_profile_sensor_data`."""
    SHAPES = QoSProfile(depth=2, reliability=ReliabilityPolicy.RELIABLE)
    """Drawn by RViz, which asks for reliable markers."""
    RESULTS = QoSProfile(
        depth=1, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL
    )
    """Latched: who comes later hears the last one too."""
    DIAGNOSTICS = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)
    CLOCK = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    """As rclcpp's ClockQoS."""


def publisher(node: Node, kind: type, topic: str, role: Role, **options: Any) -> Publisher:
    """Publish on a topic of `hasel_common.topics` in the node's namespace."""
    return node.create_publisher(kind, relative(topic), role.value, **_OVERRIDABLE, **options)


def subscription(
    node: Node, kind: type, topic: str, heard: Callable[..., Any], role: Role, **options: Any
) -> Subscription:
    """Hear a topic of `hasel_common.topics` in the node's namespace."""
    return node.create_subscription(kind, relative(topic), heard, role.value, **_OVERRIDABLE, **options)


def frame_of(node: Node, name: str) -> str:
    """Return the frame `name` of the node's rig, such as hasel/camera; in the root namespace, the name alone.

    A name that begins with / is meant as it is; tf2 wants it without.
    """
    if name.startswith("/"):
        return name.lstrip("/")
    return f"{node.get_namespace()}/{name}".lstrip("/")
