# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 topic list|echo|pub|hz`."""

import argparse
import time
from collections import deque

import numpy as np
from listing import add_listing
from messages import as_yaml, filled, interface
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from session import full_name, spin_until, type_of, wait_for

_DEPTH, _WINDOW = 1000, 10_000


def add_parsers(commands) -> None:
    """Add what `ros2 topic` knows."""
    add_listing(commands, "topics", Node.get_topic_names_and_types)
    echo = commands.add_parser("echo", help="print what is published")
    echo.add_argument("topic")
    echo.add_argument(
        "type", nargs="?", help="such as hasel_interfaces/msg/RunningError; default: that of the topic"
    )
    echo.add_argument("--once", action="store_true", help="one message")
    echo.add_argument("--field", help="one field only, such as header.stamp")
    echo.set_defaults(run=echo_topic)
    pub = commands.add_parser("pub", help="publish")
    pub.add_argument("topic")
    pub.add_argument("type")
    pub.add_argument("values", nargs="?", default="{}", help="YAML, such as '{voltage: [4000, 0]}'")
    pub.add_argument("-1", "--once", action="store_true", help="once, when somebody listens")
    pub.add_argument("-r", "--rate", type=float, default=1.0, help="messages per second (default: 1)")
    pub.add_argument("-t", "--times", type=int, default=0, help="how many (default: until Ctrl-C)")
    pub.set_defaults(run=publish)
    hz = commands.add_parser("hz", help="how often something is published")
    hz.add_argument("topic")
    hz.set_defaults(run=print_rate)


def _subscribe(node: Node, topic: str, kind: str | None, handler) -> None:
    """Hear a topic as its publishers offer it: latched and reliable where all of them are."""
    if kind is None:
        wait_for(node, lambda: node.get_publishers_info_by_topic(full_name(topic)))
        kind = type_of(topic, dict(node.get_topic_names_and_types()), "topic")
    offered = [each.qos_profile for each in node.get_publishers_info_by_topic(topic)]
    latched = bool(offered) and all(q.durability == DurabilityPolicy.TRANSIENT_LOCAL for q in offered)
    reliable = all(q.reliability == ReliabilityPolicy.RELIABLE for q in offered)
    quality = QoSProfile(
        depth=_DEPTH,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
    )
    node.create_subscription(interface(kind, "msg"), topic, handler, quality)


def echo_topic(node: Node, options: argparse.Namespace) -> None:
    """Print every message as YAML."""
    heard = []

    def show(message) -> None:
        if not (options.once and heard):
            print(as_yaml(message, options.field) + "---", flush=True)
        heard.append(True)

    _subscribe(node, options.topic, options.type, show)
    spin_until(node, lambda: options.once and heard)


def publish(node: Node, options: argparse.Namespace) -> None:
    """Publish once, some times, or until Ctrl-C."""
    message = filled(interface(options.type, "msg")(), options.values)
    publisher = node.create_publisher(type(message), options.topic, QoSProfile(depth=_DEPTH))
    times = 1 if options.once else options.times
    if options.once:
        print("Waiting for somebody to listen …", flush=True)
        spin_until(node, publisher.get_subscription_count)
    sent, begun = 0, time.monotonic()
    while not times or sent < times:
        publisher.publish(message)
        sent += 1
        print(f"publishing #{sent}: {options.topic}", flush=True)
        due = begun + sent / options.rate
        spin_until(node, lambda due=due: time.monotonic() >= due)
    publisher.wait_for_all_acked()


def print_rate(node: Node, options: argparse.Namespace) -> None:
    """Once a second the mean rate and the scatter of the intervals."""
    arrivals: deque[float] = deque(maxlen=_WINDOW)
    _subscribe(node, options.topic, None, lambda _: arrivals.append(time.monotonic()))
    while True:
        end = time.monotonic() + 1.0
        spin_until(node, lambda end=end: time.monotonic() >= end)
        if len(arrivals) < 2:
            print("no new messages", flush=True)
            continue
        steps = np.diff(arrivals)
        print(
            f"average rate: {1 / steps.mean():.3f}\n\tmin: {steps.min():.3f}s max: {steps.max():.3f}s "
            f"std dev: {steps.std():.5f}s window: {len(arrivals)}",
            flush=True,
        )
