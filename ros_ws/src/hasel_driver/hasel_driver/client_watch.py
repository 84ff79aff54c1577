"""Whether whoever asked for an experiment is still there."""

import time

from rclpy.node import Node

FEEDBACK = "/hasel/run_experiment/_action/feedback"  # to which every client of the action subscribes
GRACE_S = 0.3


class ClientWatch:
    """Notes the action's clients of now; they are gone when none of them has been there for a moment.

    A client that ends is noticed at once, one that is killed when its lease with the middleware runs out (20 s).
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._clients = self._present()
        self._missed_s: float | None = None

    def gone(self) -> bool:
        """Whether none is left; never, where none was seen at the begin."""
        if not self._clients or self._clients & self._present():
            self._missed_s = None
            return False
        now_s = time.monotonic()
        self._missed_s = now_s if self._missed_s is None else self._missed_s
        return now_s - self._missed_s > GRACE_S

    def _present(self) -> set[bytes]:
        return {bytes(info.endpoint_gid) for info in self._node.get_subscriptions_info_by_topic(FEEDBACK)}
