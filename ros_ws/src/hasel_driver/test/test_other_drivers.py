# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Who may command, and other drivers of the same name."""

import time
from contextlib import ExitStack

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")
pytest.importorskip("hasel_interfaces", reason="the workspace is not built")

from hasel_common.managed_node import node_alone
from hasel_driver.nodes.middleware import UNNAMED
from hasel_driver.nodes.other_drivers import HOLDER_SILENT_S, Claim, Rivals
from hasel_interfaces.msg import SupplyState
from std_srvs.srv import Trigger

A, B, C = b"a", b"b", b"c"


class Clock:
    """Time that a test advances."""

    now_s = 0.0

    def __call__(self) -> float:
        return self.now_s


@pytest.fixture
def clock() -> Clock:
    """At 0."""
    return Clock()


def test_arming_gives_it_to_the_only_publisher(clock):
    """Others are refused, however long the holder is silent."""
    claim = Claim(clock)
    claim.hand_out({A: "/a"})
    assert claim.holder == "/a"
    assert claim.take(A, "/a") == (True, False)
    clock.now_s = 100.0
    assert claim.take(B, "/b") == (False, False)
    assert claim.holder == "/a"


def test_without_a_publisher_the_first_that_is_heard_has_it(clock):
    """And it is told as a new one, which must begin at 0 V."""
    claim = Claim(clock)
    claim.hand_out({})
    assert claim.holder == ""
    assert claim.take(B, "/b") == (True, True)
    assert claim.take(A, "/a") == (False, False)


def test_a_node_that_comes_back_has_it_again(clock):
    """By its name, once the first is silent; two at once with one name are not one."""
    claim = Claim(clock)
    claim.hand_out({A: "/controller"})
    assert claim.take(A, "/controller") == (True, False)
    assert claim.take(C, "/controller") == (False, False)
    clock.now_s = 1.1 * HOLDER_SILENT_S
    assert claim.take(C, "/controller") == (True, True)
    assert claim.take(A, "/controller") == (False, False)


def test_nobody_comes_back_whose_name_is_not_known(clock):
    """Two that the graph does not name yet are not one."""
    claim = Claim(clock)
    claim.hand_out({A: UNNAMED})
    clock.now_s = 1.1 * HOLDER_SILENT_S
    assert claim.take(C, UNNAMED) == (False, False)


STOP = "/hasel/emergency_stop"


@pytest.fixture
def join():
    """Adds nodes, each with a context of its own, that are not spun: they are seen, and hear nothing."""
    with ExitStack() as leaving:

        def add(name: str):
            node = node_alone(name, namespace="/hasel")
            leaving.callback(node.context.shutdown)
            leaving.callback(node.destroy_node)
            return node

        yield add


def _within(condition, duration_s: float) -> bool:
    end_s = time.monotonic() + duration_s
    while not condition() and time.monotonic() < end_s:
        time.sleep(0.01)
    return condition()


@pytest.mark.parametrize("comes", ["a driver", "a service"])
def test_a_driver_that_has_not_found_itself_counts_the_others(join, comes):
    """One of those that are seen is itself; a stop that another answers to as well is not answered for all."""
    own, other = join("hasel_driver"), join("stranger")
    own.create_publisher(SupplyState, "/hasel/state", 10)
    own.create_service(Trigger, STOP, lambda _, response: response)
    rivals = Rivals(own, lambda: [STOP])
    assert not _within(rivals.found, 0.5)
    if comes == "a driver":
        other.create_publisher(SupplyState, "/hasel/state", 10)
    else:
        other.create_service(Trigger, STOP, lambda _, response: response)
    assert _within(lambda: "/hasel/stranger" in "".join(rivals.found()), 5.0)
    assert not rivals.known
    rivals.destroy()
