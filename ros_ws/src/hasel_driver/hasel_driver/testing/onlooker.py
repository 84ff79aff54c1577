"""A node that joins, listens, and leaves."""

import time

import rclpy
from hasel_common.managed_node import node_alone
from hasel_interfaces.msg import SupplyState
from rclpy.executors import SingleThreadedExecutor

PATIENCE_S = 10.0


def look_on() -> None:
    """Join with a context of its own until it has heard `/hasel/state`, as `ros2 topic echo --once` does."""
    heard: list[SupplyState] = []
    node = node_alone("onlooker")
    node.create_subscription(SupplyState, "/hasel/state", heard.append, 10)
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    end_s = time.monotonic() + PATIENCE_S
    while not heard and time.monotonic() < end_s:
        executor.spin_once(timeout_sec=0.1)
    executor.shutdown()
    node.destroy_node()
    rclpy.try_shutdown(context=node.context)
    if not heard:
        raise AssertionError(f"nothing was heard within {PATIENCE_S} s")
