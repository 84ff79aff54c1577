# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Frames from an image topic of another node."""

from collections import deque
from collections.abc import Callable

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription
from sensor_msgs.msg import CompressedImage, Image

from hasel_tracker.errors import TrackerError
from hasel_tracker.live_tracker import POSSIBLE_LATENCY_S, LiveTracker
from hasel_tracker.sources.frame import Frame, image_of

LOOK_PERIOD_S = 0.2
QUEUE_DEPTH = 50
USUAL_INTERVALS = 100
KINDS = {"sensor_msgs/msg/Image": Image, "sensor_msgs/msg/CompressedImage": CompressedImage}


class ImageTopic:
    """Puts the images of `topic` into the queue of the live tracker, as soon as someone publishes them.

    lost: images that never came, by the gaps between the stamps of those that did.
    """

    def __init__(self, node: Node, topic: str, live: Callable[[], LiveTracker]) -> None:
        self._node = node
        self._topic = topic
        self._live = live
        self._first_stamp_ns: int | None = None
        self._last_stamp_ns: int | None = None
        self._intervals_ns: deque[int] = deque(maxlen=USUAL_INTERVALS)
        self.lost = 0
        self._subscription: Subscription | None = None
        self._sent: tuple[type, ReliabilityPolicy] | None = None
        self._waiting = node.create_timer(LOOK_PERIOD_S, self._subscribe)

    def close(self) -> None:
        """Hear no image any more."""
        self._node.destroy_timer(self._waiting)
        if self._subscription is not None:
            self._node.destroy_subscription(self._subscription)

    def _subscribe(self) -> None:
        """Subscribe as the images are sent: of their type, and reliably if they are, as best effort loses large ones.

        Looked at again and again: a camera may come back sending otherwise.
        """
        publishers = self._node.get_publishers_info_by_topic(self._topic)
        if not publishers:
            return
        kinds = {each.topic_type for each in publishers}
        if len(kinds) > 1 or not kinds <= set(KINDS):
            self._live().fault = (
                f"The topic {self._topic} is of type {', '.join(sorted(kinds))}; expected {' or '.join(KINDS)}: name "
                "another one."
            )
            return
        reliable = all(each.qos_profile.reliability == ReliabilityPolicy.RELIABLE for each in publishers)
        policy = ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT
        sent = (KINDS[kinds.pop()], policy)
        if sent == self._sent:
            return
        if self._subscription is not None:
            self._node.destroy_subscription(self._subscription)
        self._sent = sent
        self._subscription = self._node.create_subscription(
            sent[0], self._topic, self._take, QoSProfile(depth=QUEUE_DEPTH, reliability=policy)
        )

    def _take(self, message: Image | CompressedImage) -> None:
        now_ns = self._node.get_clock().now().nanoseconds
        stamp_ns = message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec
        late_s = (now_ns - stamp_ns) * 1e-9
        if stamp_ns and stamp_ns == self._last_stamp_ns:
            self._live().fault = (
                f"The images on {self._topic} are all stamped alike; those after the first are left out: check the "
                "camera driver's stamps."
            )
            return
        if stamp_ns and not -POSSIBLE_LATENCY_S < late_s < POSSIBLE_LATENCY_S:
            self._live().fault = (
                f"The images on {self._topic} are stamped {abs(late_s):.4g} s {'before' if late_s > 0 else 'after'} "
                "they arrive, so their clock is another one than the drive's: set the camera's clock, or use_sim_time."
            )
        stamp_ns = stamp_ns or now_ns
        self._first_stamp_ns = self._first_stamp_ns or stamp_ns
        self._count_lost(stamp_ns)
        try:
            image = image_of(message)
        except TrackerError as error:
            self._live().fault = str(error)
            return
        time_s = (stamp_ns - self._first_stamp_ns) * 1e-9
        self._live().queue.put(Frame(0, time_s, image=image, stamp_ns=stamp_ns))

    def _count_lost(self, stamp_ns: int) -> None:
        last, self._last_stamp_ns = self._last_stamp_ns, stamp_ns
        if last is None or stamp_ns <= last:
            return
        self._intervals_ns.append(stamp_ns - last)
        # The camera's own interval: the short ones among the last, which no loss has stretched.
        usual = sorted(self._intervals_ns)[len(self._intervals_ns) // 10]
        self.lost += max(round((stamp_ns - last) / usual) - 1, 0)
