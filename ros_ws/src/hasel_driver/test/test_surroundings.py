# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What comes from other nodes, whole, and what they must not do."""

import math
import time
from types import SimpleNamespace

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")

import rclpy
from hasel_driver.nodes import surroundings
from hasel_driver.nodes.emergency_stop import StopHolders
from hasel_driver.nodes.other_drivers import NOT_TOLD
from hasel_driver.nodes.surroundings import DISCOVERY_S, NAMING_S, HostSurroundings, UrgentInputs
from hasel_driver.protocol.faults import FaultCode, RefusedError
from hasel_driver.testing.ros_client import RosClient

MANY = 50


@pytest.fixture
def ros():
    """A client of the test's own: if the test is repeated, nothing of the failed attempt is left."""
    client = RosClient()
    yield client
    client.close()


@pytest.fixture
def inputs():
    """Urgent inputs, held up by everything they tell, and what they have told."""
    told = {"commands": [], "stops": []}

    def take(kind: str, value) -> None:
        time.sleep(0.002)
        told[kind].append(value)

    rclpy.init()
    inputs = UrgentInputs(
        "/hasel",
        lambda: ["/hasel/arm"],
        lambda _publisher, _name, voltage_v, _age_s: take("commands", voltage_v),
        lambda stop, _who: take("stops", stop),
        lambda: None,
    )
    yield told
    inputs.close()
    rclpy.try_shutdown()


def test_every_watch_runs_on_a_steady_clock(tmp_path):
    """Neither simulated time nor a step of the system's clock holds up a timer of the node or of its inputs."""
    from hasel_driver.nodes.driver_node import DriverNode
    from rclpy.clock import ClockType
    from rclpy.parameter import Parameter

    rclpy.init()
    history = Parameter("history_file", value=str(tmp_path / "history.jsonl"))
    node = DriverNode(parameter_overrides=[history])
    try:
        timers = [*node.timers, *node._inputs._node.timers]
        assert len(timers) == 4
        assert {timer.clock.clock_type for timer in timers} == {ClockType.STEADY_TIME}
    finally:
        node.leave()
        node.destroy_node()
        rclpy.try_shutdown()


def greet_until_heard(ros, commands: list) -> None:
    """Until the two ends know each other, and no greeting is under way any more: each has its own voltage."""
    for greeting in range(1, 300):
        ros.command((float(greeting), 0.0))
        time.sleep(0.1)
        if commands:
            ros.wait(lambda last=greeting: commands[-1][0] == last)
            break
    else:
        known = ros.commands.get_subscription_count()
        pytest.fail(f"no greeting was heard within 30 s; the publisher knows of {known} subscriptions")
    commands.clear()


def test_later_commands_do_not_push_out_a_nan(ros, inputs):
    """Commands that come faster than they are taken are all seen, so that none that is not a number is missed."""
    greet_until_heard(ros, inputs["commands"])
    for _ in range(MANY):
        ros.command((1000.0, math.nan))
        ros.command((1000.0, 0.0))
    ros.wait(lambda: len(inputs["commands"]) == 2 * MANY)
    assert sum(math.isnan(voltage) for command in inputs["commands"] for voltage in command) == MANY


def test_a_stop_that_is_taken_back_at_once_is_heard(ros, inputs):
    """True is told although false follows immediately."""
    ros.emergency_stop_topic(False)
    ros.wait(lambda: inputs["stops"] == [False])
    for index in range(2 * MANY):
        ros.emergency_stop_topic(index % 2 == 0)
        time.sleep(5e-4)  # this publisher, as is usual for a latched topic, keeps the last message only
    ros.wait(lambda: len(inputs["stops"]) == 2 * MANY + 1)
    assert sum(inputs["stops"]) == MANY
    ros.drop_emergency_stop_topic()


NAMED, NAMELESS = "/hasel/hasel_driver on bench2 (process 7)", f"/stranger {NOT_TOLD}"


class Graph:
    """Stands for the inputs: quiet unless a test says otherwise."""

    def __init__(self) -> None:
        self.holders = StopHolders()
        self.others: list[str] = []
        self.deaf: str | None = None
        self.publishers = {b"a": "/a"}
        self.command_topic = "/hasel/command"
        self.stop_topic = SimpleNamespace(present=dict, unheard=lambda: self.deaf)
        self.rivals = SimpleNamespace(known=True, found=lambda: self.others)

    def commanders(self) -> dict[bytes, str]:
        """By identifier."""
        return self.publishers


@pytest.fixture
def graph() -> Graph:
    """One commander, nobody else."""
    return Graph()


@pytest.fixture
def clock(monkeypatch) -> SimpleNamespace:
    """Time that a test advances."""
    clock = SimpleNamespace(now_s=100.0)
    monkeypatch.setattr(surroundings, "time", SimpleNamespace(monotonic=lambda: clock.now_s))
    return clock


def test_a_quiet_graph_allows_arming_and_is_no_threat(graph):
    """Nothing is refused, nothing is a fault."""
    around = HostSurroundings(graph)
    around.check_arming()
    assert around.threat() is None


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda graph: graph.holders.take(b"p", 1, "/panel", True), "held by /panel"),
        (lambda graph: setattr(graph, "deaf", "/x publishes String"), "might not be heard: /x"),
        (lambda graph: setattr(graph, "others", [NAMED]), "on bench2"),
        (lambda graph: setattr(graph.rivals, "known", False), "not known yet"),
        (lambda graph: graph.publishers.update({b"b": "/b"}), "publishes /hasel/command: /a, /b"),
    ],
)
def test_arming_is_refused_with_the_name(graph, change, words):
    """Whoever is in the way is named."""
    change(graph)
    with pytest.raises(RefusedError, match=words):
        HostSurroundings(graph).check_arming()


def test_another_driver_is_a_fault_at_once_or_once_its_name_cannot_be_learnt(graph, clock):
    """With its name and host at once; one that tells no host is given a moment, and no more."""
    around = HostSurroundings(graph)
    graph.others = [NAMED]
    assert around.threat().code is FaultCode.TWO_DRIVERS
    around.calm()
    graph.others = [NAMELESS]
    assert around.threat() is None
    clock.now_s += 1.1 * NAMING_S
    assert "/stranger" in around.threat().detail


def test_a_stop_that_cannot_be_heard_is_a_fault_when_it_lasts(graph, clock):
    """A new publisher is known before it is connected."""
    around = HostSurroundings(graph)
    graph.deaf = "of 2 publishers only 1 is connected"
    assert around.threat() is None
    clock.now_s += 0.9 * DISCOVERY_S
    graph.deaf = None
    assert around.threat() is None
    graph.deaf = "again"
    clock.now_s += 0.9 * DISCOVERY_S
    assert around.threat() is None
    clock.now_s += 1.1 * DISCOVERY_S
    assert around.threat().code is FaultCode.STOP_NOT_HEARD
