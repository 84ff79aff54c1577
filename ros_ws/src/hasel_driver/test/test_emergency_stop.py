# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The emergency stop: who holds it, service, latched topic, and what it takes to go on."""

import time
from contextlib import contextmanager

import pytest
from hasel_driver.nodes.emergency_stop import StopHolders
from hasel_driver.nodes.middleware import UNNAMED
from hasel_driver.protocol.faults import FaultCode
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Bool

A, B = b"a", b"b"


def test_only_its_own_false_releases():
    """The order of arrival of other publishers' messages does not matter."""
    holders = StopHolders()
    holders.take(A, 1, "/a", True)
    holders.take(B, 1, "/b", False)
    assert holders.names({A: "/a", B: "/b"}) == ["/a"]
    holders.take(A, 2, "/a", False)
    assert not holders


def test_a_message_heard_twice_counts_once():
    """A late copy of an old true does not take the place of a newer false."""
    holders = StopHolders()
    assert holders.take(A, 1, "/a", True)
    assert holders.take(A, 2, "/a", False)
    assert not holders.take(A, 1, "/a", True)
    assert not holders


def test_an_older_stop_heard_after_its_release_is_still_a_stop():
    """Each of our subscriptions has its own queue: it is told once, and holds nothing any more."""
    holders = StopHolders()
    holders.take(A, 2, "/a", False)
    assert holders.take(A, 1, "/a", True)
    assert not holders.take(A, 1, "/a", True)
    assert not holders


def test_release_names_who_held():
    """Whoever is gone is marked, and released by the service only."""
    holders = StopHolders()
    holders.take(A, 1, "/a", True)
    assert holders.names({}) == ["/a (gone)"]
    assert holders.release() == ["/a"]
    assert not holders


def test_a_name_is_learnt_late_and_kept():
    """A node that ends is nameless for a moment before its publisher goes; who held the stop is still said."""
    holders = StopHolders()
    holders.take(A, 1, UNNAMED, True)
    assert holders.names({A: UNNAMED}) == [UNNAMED]
    assert holders.names({A: "/a"}) == ["/a"]
    assert holders.names({A: UNNAMED}) == ["/a"]
    holders.take(A, 2, UNNAMED, True)
    assert holders.names({}) == ["/a (gone)"]


TOPIC = "/hasel/emergency_stop"

STANDBY, ARMED, ACTIVE, FAULT = range(4)

CHARGED_V = 1500.0  # far above the 400 V whose fall proves a ground contact, whatever leaks before it closes


@pytest.mark.rounds(3, 40)
def test_service_grounds_and_latches(provoke, ros, rounds):
    """Of charged muscles the answer is the supply's own proof; afterwards nothing re-arms by itself."""

    def stop() -> float:
        ros.wait(lambda: min(map(abs, ros.state.measured_voltage)) > CHARGED_V)
        at_s = time.monotonic()
        answer = ros.trigger("emergency_stop")
        assert (answer.success, "reports its output grounded" in answer.message) == (True, True), answer
        return at_s

    for _ in range(rounds):
        provoke(stop, FaultCode.EMERGENCY_STOP)
        assert ros.trigger("clear_fault").success
        ros.await_mode(STANDBY)


def test_no_proof_no_success(driver, shared_rig, ros):
    """With a silent supply the service says that nothing is proven."""
    driver.arm()
    ros.drive(lambda: shared_rig.live)
    shared_rig.say("silence")
    answer = ros.trigger("emergency_stop")
    assert (answer.success, "Treat the output as live" in answer.message) == (False, True)
    assert "Nothing proves" in ros.await_mode(FAULT).fault_text


@pytest.mark.rounds(1, 40)
def test_topic_stops_and_holds(provoke, ros, rounds):
    """True on the topic grounds; until false is published the fault cannot be cleared."""
    for _ in range(rounds):
        provoke(lambda: ros.emergency_stop_topic(True), FaultCode.EMERGENCY_STOP)
        assert "publish false" in ros.trigger("clear_fault").message
        assert ros.state.emergency_stop_holders == ["/user"]
        ros.emergency_stop_topic(False)
        time.sleep(0.2)
        assert ros.state.mode == FAULT
        assert ros.trigger("clear_fault").success
        ros.await_mode(STANDBY)


QUALITIES = {
    "default": QoSProfile(depth=10),
    "best effort": QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT),
    "best effort, latched": QoSProfile(
        depth=1, reliability=ReliabilityPolicy.BEST_EFFORT, durability=DurabilityPolicy.TRANSIENT_LOCAL
    ),
}


@pytest.mark.parametrize("quality", QUALITIES)
def test_every_quality_of_service_is_heard(provoke, driver, ros, quality):
    """A publisher as rqt and joystick nodes make it stops as one of the latched topic does."""
    ros.emergency_stop_topic(False, QUALITIES[quality])
    ros.wait(lambda: not driver_says_unheard(ros))
    provoke(lambda: ros.emergency_stop_topic(True), FaultCode.EMERGENCY_STOP)
    ros.emergency_stop_topic(False)
    ros.wait(lambda: ros.trigger("clear_fault").success)


def driver_says_unheard(ros) -> bool:
    """Whether arming is refused because of a publisher that is not connected; leaves the supply disarmed."""
    answer = ros.trigger("arm")
    ros.trigger("disarm")
    return "might not be heard" in answer.message


@contextmanager
def publisher(name: str, kind=Bool):
    """Another node that publishes the stop."""
    from hasel_driver.testing.ros_client import another_node

    with another_node(name) as node:
        yield node.create_publisher(kind, TOPIC, 10)


def test_only_who_stopped_may_release(driver, ros):
    """Another publisher's false does not take a stop back; its own does, and so does the explicit service."""
    ros.await_mode(STANDBY)
    with publisher("joystick") as first, publisher("panel") as second:
        ros.wait(lambda: first.get_subscription_count() >= 2 and second.get_subscription_count() >= 2)
        first.publish(Bool(data=True))
        ros.await_mode(FAULT)
        second.publish(Bool(data=False))
        ros.wait(lambda: ros.state.emergency_stop_holders == ["/joystick"])
        time.sleep(0.2)
        assert "held by /joystick" in ros.trigger("clear_fault").message
        second.publish(Bool(data=True))
        ros.wait(lambda: ros.state.emergency_stop_holders == ["/joystick", "/panel"])
        first.publish(Bool(data=False))
        ros.wait(lambda: ros.state.emergency_stop_holders == ["/panel"])
        assert not ros.trigger("clear_fault").success
        second.publish(Bool(data=False))
        ros.wait(lambda: ros.trigger("clear_fault").success)
        first.publish(Bool(data=True))
        ros.await_mode(FAULT)
    ros.wait(lambda: ros.state.emergency_stop_holders == ["/joystick (gone)"])
    assert not ros.trigger("clear_fault").success
    assert "Released what /joystick held" in ros.trigger("release_emergency_stop").message
    assert ros.state.mode == FAULT
    assert ros.trigger("clear_fault").success


def test_a_publisher_that_cannot_be_heard_forbids_arming(driver, ros):
    """One of another type on the topic is no emergency stop, and somebody believes it is one."""
    from std_msgs.msg import String

    ros.await_mode(STANDBY)
    with publisher("mistaken", String):
        for _ in range(50):  # until the driver has learnt of it
            answer = ros.trigger("arm")
            if not answer.success:
                break
            assert ros.trigger("disarm").success
            time.sleep(0.1)
        assert "publishes std_msgs/msg/String" in answer.message
        assert ros.await_mode(STANDBY)
    ros.wait(lambda: ros.trigger("arm").success)


@pytest.mark.parametrize("service", ["disarm", "emergency_stop"])
def test_a_charged_output_is_no_success(driver, shared_rig, ros, service):
    """With a welded contact neither stop nor disarm answers "grounded", nor does any state; arming is refused."""
    driver.arm()
    ros.drive(lambda: shared_rig.live and ros.state.measured_voltage[0] > 2900)
    shared_rig.say("weld")
    answer = ros.trigger(service)
    assert (answer.success, "NOT proven" in answer.message) == (False, True)
    state = ros.await_mode(FAULT)
    assert (state.grounded, "treat it as live" in state.fault_text) == (False, True)
    assert not ros.trigger("arm").success
    shared_rig.say("recover")
    ros.wait(lambda: ros.state.ground != ros.state.GROUND_NOT)
    assert ros.state.ground == ros.state.GROUND_COMMANDED
    assert ros.trigger("clear_fault").success
    ros.wait(lambda: ros.state.grounded)


def test_a_stop_that_no_monitor_can_see_is_no_success(driver, shared_rig, ros):
    """The divider is off and a contact welded: nothing is measured, so nothing is proven, and the answer says so."""
    driver.arm()
    ros.drive(lambda: shared_rig.live and ros.state.measured_voltage[0] > 2900)
    shared_rig.say("weld")
    shared_rig.say("blind")
    answer = ros.trigger("emergency_stop")
    assert not answer.success, answer
    assert "treat it as live" in answer.message.lower()
    shared_rig.say("recover")
    ros.wait(lambda: ros.trigger("clear_fault").success)
    ros.wait(lambda: ros.state.ground == ros.state.GROUND_COMMANDED)


def test_deactivating_a_charged_output_is_a_fault(driver, shared_rig, ros):
    """What the lifecycle cannot prove it calls FAULT."""
    from lifecycle_msgs.msg import Transition

    driver.arm()
    ros.drive(lambda: shared_rig.live and ros.state.measured_voltage[0] > 2900)
    shared_rig.say("unground")
    ros.transition(Transition.TRANSITION_DEACTIVATE)
    ros.await_mode(FAULT)
    shared_rig.say("recover")
    ros.transition(Transition.TRANSITION_ACTIVATE)
    ros.wait(lambda: ros.trigger("clear_fault").success)
    ros.wait(lambda: ros.state.grounded)
