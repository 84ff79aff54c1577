"""Hears `emergency_stop` from every publisher, whatever its quality of service."""

from collections.abc import Callable

from hasel_common.topics import EMERGENCY_STOP, TOPIC_TYPES, relative
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.topic_endpoint_info import TopicEndpointInfo
from std_msgs.msg import Bool

from hasel_driver.graph_names import UNNAMED, full_name
from hasel_driver.identified_subscription import IDENTIFIER_BYTES, IdentifiedSubscription
from hasel_driver.stop_holders import StopHolders

TYPE = TOPIC_TYPES[EMERGENCY_STOP]
DEPTH = 100
# A subscription is not matched by a publisher that offers less than it asks for, and is not given more than it asks
# for: the last of these hears everybody, the others hear whoever offers more better.
QUALITIES = tuple(
    QoSProfile(depth=DEPTH, reliability=reliability, durability=durability)
    for reliability, durability in (
        (ReliabilityPolicy.RELIABLE, DurabilityPolicy.TRANSIENT_LOCAL),
        (ReliabilityPolicy.RELIABLE, DurabilityPolicy.VOLATILE),
        (ReliabilityPolicy.BEST_EFFORT, DurabilityPolicy.VOLATILE),
    )
)


class StopTopic:
    """Calls `on_change(asserted, who)` for each message, once."""

    def __init__(self, node: Node, holders: StopHolders, on_change: Callable[[bool, str], None]) -> None:
        self._node, self._holders, self._on_change = node, holders, on_change
        group = MutuallyExclusiveCallbackGroup()
        self._subscriptions = [
            IdentifiedSubscription(node, Bool, relative(EMERGENCY_STOP), self._take, quality, group)
            for quality in QUALITIES
        ]
        self.topic = self._subscriptions[0].topic_name

    def present(self) -> dict[bytes, str]:
        """Names of the publishers that exist, by identifier."""
        return {bytes(info.endpoint_gid[:IDENTIFIER_BYTES]): full_name(info) for info in self._publishers()}

    def unheard(self) -> str | None:
        """Why a publisher that exists cannot be heard; None if all can."""
        publishers = self._publishers()
        for info in publishers:
            if info.topic_type != TYPE:
                return f"{full_name(info)} publishes {info.topic_type} on {self.topic}, {TYPE} is expected"
        heard = self._subscriptions[-1].publishers
        if heard < len(publishers):
            names = ", ".join(map(full_name, publishers))
            return f"of {len(publishers)} publishers of {self.topic} ({names}) only {heard} are connected"
        return None

    def destroy(self) -> None:
        """Stop listening."""
        for subscription in self._subscriptions:
            subscription.destroy()

    def _publishers(self) -> list[TopicEndpointInfo]:
        return self._node.get_publishers_info_by_topic(relative(EMERGENCY_STOP))

    def _take(self, publisher: bytes, sequence: int, message: Bool) -> None:
        name = self.present().get(publisher, UNNAMED)
        if self._holders.take(publisher, sequence, name, message.data):
            self._on_change(message.data, name)
