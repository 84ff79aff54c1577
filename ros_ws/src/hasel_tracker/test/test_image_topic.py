# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Images that a topic lost."""

from types import SimpleNamespace

from hasel_tracker.image_topic import ImageTopic
from hasel_tracker.sources.frame import DropOldestQueue
from rclpy.qos import ReliabilityPolicy
from sensor_msgs.msg import CompressedImage, Image


def test_images_that_never_came_are_counted():
    """Of 601 images at 60 per second every third is lost on the way: the gaps in the stamps tell how many."""
    topic = ImageTopic(SimpleNamespace(create_timer=lambda *_: None), "/camera/image_raw", lambda: None)
    for index in range(601):
        if index % 3 != 2:
            topic._count_lost(round(index * 1e9 / 60))
    assert topic.lost == 200


class Graph:
    """A node that sees publishers, and what it subscribed to."""

    def __init__(self):
        self.publishers, self.heard, self.now_ns = [], None, 50_000_000_000

    def create_timer(self, _period, look):
        self.look = look

    def get_publishers_info_by_topic(self, _topic):
        return self.publishers

    def create_subscription(self, kind, topic, take, qos):
        self.heard = (kind, qos.reliability)
        return take

    def destroy_subscription(self, _subscription):
        self.heard = None

    def get_clock(self):
        return SimpleNamespace(now=lambda: SimpleNamespace(nanoseconds=self.now_ns))


def publisher(kind: str, reliable: bool):
    """What the graph says of a publisher."""
    policy = ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT
    return SimpleNamespace(
        topic_type=f"sensor_msgs/msg/{kind}", qos_profile=SimpleNamespace(reliability=policy)
    )


def watched():
    """A graph, a topic of any name on it, and the live tracker that gets its images."""
    graph = Graph()
    live = SimpleNamespace(fault="", queue=DropOldestQueue(8))
    return graph, ImageTopic(graph, "/camera/front", lambda: live), live


def test_the_subscription_follows_the_publisher():
    """Compressed images under any name are heard, and a camera that comes back with another reliability or type too."""
    graph, _, live = watched()
    for sent in (("CompressedImage", True), ("CompressedImage", False), ("Image", False)):
        graph.publishers = [publisher(*sent)]
        graph.look()
        policy = ReliabilityPolicy.RELIABLE if sent[1] else ReliabilityPolicy.BEST_EFFORT
        assert graph.heard == ({"Image": Image, "CompressedImage": CompressedImage}[sent[0]], policy)
    graph.publishers = [publisher("PointCloud2", True)]
    graph.look()
    assert "is of type sensor_msgs/msg/PointCloud2; expected sensor_msgs/msg/Image" in live.fault


def image(sec: int) -> Image:
    """A small picture stamped so."""
    message = Image(height=2, width=2, encoding="bgr8", step=6, data=bytes(12))
    message.header.stamp.sec = sec
    return message


def test_stamps_that_cannot_be_are_said():
    """Of another clock, or never changing: the diagnostics get a sentence, and no two frames have one time."""
    _, topic, live = watched()
    topic._take(image(49))
    assert not live.fault
    topic._take(image(49))
    assert "stamped alike" in live.fault
    assert len(live.queue) == 1
    topic._take(image(1_700_000_000))
    assert "after they arrive, so their clock is another one" in live.fault
