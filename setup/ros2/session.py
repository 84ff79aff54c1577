# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A node that lives as long as one command, and knows who else is there."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from difflib import get_close_matches

import rclpy
from messages import NotUnderstoodError
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

_QUIET_S, _ALONE_S, _LONGEST_S = 1.0, 5.0, 10.0
"""The others are known when nobody new has come for so long, or nobody at all; nobody waits longer for a name."""


@contextmanager
def session() -> Iterator[Node]:
    """A node without parameters and logs of its own."""
    rclpy.init()
    node = Node("ros2_command", enable_rosout=False, start_parameter_services=False)
    try:
        yield node
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def spin_until(node: Node, condition: Callable[[], object], seconds: float | None = None) -> bool:
    """Spin until something is true or the time is over; whether it is true."""
    end = None if seconds is None else time.monotonic() + seconds
    while not condition():
        if end is not None and time.monotonic() > end:
            return False
        try:
            rclpy.spin_once(node, timeout_sec=0.05)
        except ExternalShutdownException:
            raise KeyboardInterrupt from None
        if not rclpy.ok():
            raise KeyboardInterrupt
    return True


def _known(node: Node) -> tuple[list, ...]:
    return (
        sorted(node.get_node_names_and_namespaces()),
        sorted(name for name, _ in node.get_topic_names_and_types()),
        sorted(name for name, _ in node.get_service_names_and_types()),
    )


def discover(node: Node) -> None:
    """Wait until no further node, topic or service turns up."""
    alone = known = _known(node)
    since = time.monotonic()
    while time.monotonic() - since < (_ALONE_S if known == alone else _QUIET_S):
        rclpy.spin_once(node, timeout_sec=0.05)
        if (now := _known(node)) != known:
            known, since = now, time.monotonic()


def wait_for(node: Node, there: Callable[[], object]) -> None:
    """Wait until something that was named is there, or long enough to say that it is not."""
    spin_until(node, there, _LONGEST_S)


def full_name(name: str) -> str:
    """With the leading slash that may be left out."""
    return name if name.startswith("/") else f"/{name}"


def type_of(name: str, known: dict[str, list[str]], what: str) -> str:
    """The type of a topic, service or action that is there. Raises NotUnderstoodError with the nearest."""
    full = full_name(name)
    if full not in known:
        nearest = get_close_matches(full, known, n=1, cutoff=0.0)
        hint = f"; did you mean {nearest[0]}?" if nearest else "; none is: start its node first"
        raise NotUnderstoodError(f"There is no {what} {full} now{hint}")
    return known[full][0]
