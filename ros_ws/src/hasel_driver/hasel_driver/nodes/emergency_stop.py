# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The topic `emergency_stop`: heard from every publisher, and who of them holds the stop."""

import threading
from collections.abc import Callable, Mapping

from hasel_common.topics import EMERGENCY_STOP, TOPIC_TYPES, relative
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Bool

from hasel_driver.nodes.middleware import UNNAMED, IdentifiedSubscription, full_name, publishers_of

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


class StopHolders:
    """Publishers are told apart by their identifier in the middleware; names are for people. For any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._holding: dict[bytes, str] = {}
        self._last_sequence: dict[bytes, int] = {}
        self._stops: dict[bytes, set[int]] = {}  # sequence numbers of those that were heard

    def take(self, publisher: bytes, sequence: int, name: str, asserted: bool) -> bool:
        """Note a message; False for one that was heard already, by another of our subscriptions.

        A stop that arrives after its own release holds nothing any more, and still is one.
        """
        with self._lock:
            stops = self._stops.setdefault(publisher, set())
            known = sequence != 0 and sequence in stops
            if asserted:
                stops.add(sequence)
            if sequence and sequence <= self._last_sequence.get(publisher, 0):
                return asserted and not known
            self._last_sequence[publisher] = sequence
            if asserted:
                self._note(publisher, name)
            else:
                self._holding.pop(publisher, None)
        return True

    def release(self) -> list[str]:
        """Take every flag back; the names of those who held one."""
        with self._lock:
            names = sorted(self._holding.values())
            self._holding.clear()
        return names

    def names(self, present: Mapping[bytes, str]) -> list[str]:
        """Who holds the stop; a publisher that is not among those `present` is marked as gone."""
        with self._lock:
            for publisher in self._holding.keys() & present.keys():
                self._note(publisher, present[publisher])
            return sorted(
                name if publisher in present else f"{name} (gone)"
                for publisher, name in self._holding.items()
            )

    def _note(self, publisher: bytes, name: str) -> None:
        """A name may be learnt later, and is kept: a node that ends is nameless before its publisher goes."""
        if name != UNNAMED or publisher not in self._holding:
            self._holding[publisher] = name

    def __bool__(self) -> bool:
        return bool(self._holding)


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
        return publishers_of(self._node, relative(EMERGENCY_STOP))

    def unheard(self) -> str | None:
        """Why a publisher that exists cannot be heard; None if all can."""
        publishers = self._node.get_publishers_info_by_topic(relative(EMERGENCY_STOP))
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

    def _take(self, publisher: bytes, sequence: int, message: Bool) -> None:
        name = self.present().get(publisher, UNNAMED)
        if self._holders.take(publisher, sequence, name, message.data):
            self._on_change(message.data, name)
