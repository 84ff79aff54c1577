# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 action list|send_goal`."""

import argparse

from action_msgs.msg import GoalStatus
from listing import add_listing
from messages import NotUnderstoodError, as_yaml, filled, interface
from rclpy.action import ActionClient, get_action_names_and_types
from rclpy.node import Node
from session import spin_until

_STATUS = {
    GoalStatus.STATUS_SUCCEEDED: "SUCCEEDED",
    GoalStatus.STATUS_CANCELED: "CANCELED",
    GoalStatus.STATUS_ABORTED: "ABORTED",
}
_PATIENCE_S = 10.0


def add_parsers(commands) -> None:
    """Add what `ros2 action` knows."""
    add_listing(commands, "actions", get_action_names_and_types)
    goal = commands.add_parser("send_goal", help="send a goal, print its result; Ctrl-C cancels it")
    goal.add_argument("action")
    goal.add_argument("type", help="such as hasel_interfaces/action/RunExperiment")
    goal.add_argument("values", nargs="?", default="{}", help="YAML, such as '{voltage: 4000, frequency: 2}'")
    goal.add_argument("-f", "--feedback", action="store_true", help="print feedback as it comes")
    goal.set_defaults(run=send_goal)


def send_goal(node: Node, options: argparse.Namespace) -> None:
    """Send it, follow it to its end. Raises NotUnderstoodError where it is rejected."""
    kind = interface(options.type, "action")
    goal = filled(kind.Goal(), options.values)
    client = ActionClient(node, kind, options.action)
    print("Waiting for an action server to become available...", flush=True)
    spin_until(node, client.server_is_ready)
    print(f"Sending goal:\n{as_yaml(goal)}", flush=True)

    def show(feedback) -> None:
        print(f"Feedback:\n{as_yaml(feedback.feedback)}", flush=True)

    asked = client.send_goal_async(goal, show if options.feedback else None)
    spin_until(node, asked.done)
    handle = asked.result()
    if not handle.accepted:
        raise NotUnderstoodError("Goal was rejected.")
    result = handle.get_result_async()
    try:
        spin_until(node, result.done)
    except KeyboardInterrupt:
        print("Canceling goal...", flush=True)
        cancelled = handle.cancel_goal_async()
        spin_until(node, lambda: cancelled.done() and result.done(), _PATIENCE_S)
        raise
    print(f"Result:\n{as_yaml(result.result().result)}", flush=True)
    print(f"Goal finished with status: {_STATUS.get(result.result().status, 'UNKNOWN')}", flush=True)
