# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A node's entry in `/diagnostics`."""

import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from hasel_common.diagnostics import Diagnostics, Level, Part
from hasel_common.endpoints import Role, subscription
from hasel_common.topics import DIAGNOSTICS
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node


@pytest.fixture
def node():
    """In a namespace, as beside a second rig."""
    context = rclpy.Context()
    rclpy.init(context=context)
    made = Node("driver", namespace="/rig_2", context=context)
    yield made
    made.destroy_node()
    rclpy.shutdown(context=context)


def test_an_entry_says_which_node_and_part_how_it_is_and_why(node):
    """Whatever the values are, they are told as text; the stamp is the node's clock."""
    heard: list[DiagnosticArray] = []
    kept = subscription(node, DiagnosticArray, DIAGNOSTICS, heard.append, Role.DIAGNOSTICS)
    diagnostics = Diagnostics(node, Part.SUPPLY)
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    for _ in range(100):
        diagnostics.tell(
            Level.ERROR, "FAULT: short circuit", {"command_age_s": 0.25, "armed": False}, "shvps"
        )
        executor.spin_once(timeout_sec=0.1)
        if heard:
            break
    (entry,) = heard[0].status
    assert (entry.name, entry.level) == ("rig_2/driver: supply", DiagnosticStatus.ERROR)
    assert (entry.message, entry.hardware_id) == ("FAULT: short circuit", "shvps")
    assert {value.key: value.value for value in entry.values} == {"command_age_s": "0.25", "armed": "False"}
    assert heard[0].header.stamp.sec > 0
    executor.shutdown()
    node.destroy_subscription(kept)
