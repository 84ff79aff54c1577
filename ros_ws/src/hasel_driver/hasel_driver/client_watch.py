"""Whether whoever asked for an experiment is still there."""

import time

from rclpy.node import Node

FEEDBACK = "run_experiment/_action/feedback"  # to which every client of the action subscribes
GRACE_S = 0.3


class ClientWatch:
    """Notes the action's clients of now; which of them sent the goal ROS does not tell, so each of them must stay.

    A client that ends is noticed at once, one that is killed when its lease with the middleware runs out (20 s).
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._clients = self._present()
        self._missed_s: float | None = None

    def gone(self) -> str | None:
        """The name of one that has been gone for a moment."""
        present = self._present()
        missed = [name for identifier, name in self._clients.items() if identifier not in present]
        if not missed:
            self._missed_s = None
            return None
        now_s = time.monotonic()
        self._missed_s = now_s if self._missed_s is None else self._missed_s
        return missed[0] if now_s - self._missed_s > GRACE_S else None

    def _present(self) -> dict[bytes, str]:
        return {
            bytes(info.endpoint_gid): info.node_name
            for info in self._node.get_subscriptions_info_by_topic(FEEDBACK)
        }
