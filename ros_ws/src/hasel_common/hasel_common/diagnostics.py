# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A node's entry in `/diagnostics` (REP 107): how it is, one sentence of why, and the numbers behind it."""

from collections.abc import Mapping
from enum import Enum

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node

from hasel_common.endpoints import Role, publisher
from hasel_common.topics import DIAGNOSTICS


class Level(Enum):
    """As of diagnostic_msgs/DiagnosticStatus."""

    OK = DiagnosticStatus.OK
    WARN = DiagnosticStatus.WARN
    ERROR = DiagnosticStatus.ERROR


class Part(Enum):
    """What an entry is about, as it ends its name; the aggregator of hasel_bringup has a branch for each."""

    SUPPLY = "supply"
    TRACKING = "tracking"
    SIMULATION = "simulation"
    IDENTIFICATION = "identification"
    NODES = "nodes"


class Diagnostics:
    """Publishes the entry `<node>: <part>` of one node."""

    def __init__(self, node: Node, part: Part) -> None:
        self._node, self._part = node, part
        self._publisher = publisher(node, DiagnosticArray, DIAGNOSTICS, Role.DIAGNOSTICS)

    def tell(self, level: Level, sentence: str, values: Mapping[str, object], hardware: str = "") -> None:
        """values: by their names, with units where they have some; hardware: which device it is about."""
        entry = DiagnosticStatus(
            level=level.value,
            name=f"{self._node.get_fully_qualified_name().lstrip('/')}: {self._part.value}",
            message=sentence,
            hardware_id=hardware,
            values=[KeyValue(key=key, value=str(value)) for key, value in values.items()],
        )
        array = DiagnosticArray(status=[entry])
        array.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(array)
