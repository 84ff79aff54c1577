"""Nodes with a lifecycle: states, failures, illegal transitions."""

import threading

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")

import rclpy
from hasel_common.managed_node import ManagedNode, Return, start_and_spin
from hasel_common.node_parameter import AUTOSTART


class Lamp(ManagedNode):
    """Notes what it is told; its bulb may be missing."""

    expected_errors = (ValueError,)

    def __init__(self, autostart: bool = True) -> None:
        super().__init__("lamp")
        self.declare_parameter(AUTOSTART[0], autostart)
        self.done: list[str] = []
        self.bulb = True

    def configure(self) -> None:
        if not self.bulb:
            raise ValueError("there is no bulb: put one in")
        self.done.append("configure")

    def activate(self) -> None:
        self.done.append("activate")

    def deactivate(self) -> None:
        self.done.append("deactivate")

    def cleanup(self) -> None:
        self.done.append("cleanup")


@pytest.fixture
def lamp():
    """A lamp in a context of its own."""
    rclpy.init()
    lamp = Lamp()
    yield lamp
    lamp.destroy_node()
    rclpy.try_shutdown()


def test_it_begins_rests_and_begins_again(lamp):
    """Each transition calls its own method; `active` tells whether it is at work."""
    lamp.begin()
    assert lamp.active
    assert lamp.trigger_deactivate() == Return.SUCCESS
    assert not lamp.active
    assert lamp.trigger_activate() == Return.SUCCESS
    assert lamp.trigger_shutdown() == Return.SUCCESS
    assert lamp.done == ["configure", "activate", "deactivate", "activate", "deactivate", "cleanup"]


def test_what_cannot_be_configured_says_why_and_may_be_tried_again(lamp):
    """`begin` raises it; the transition fails and the node stays as it was."""
    lamp.bulb = False
    with pytest.raises(ValueError, match="there is no bulb"):
        lamp.begin()
    assert lamp.trigger_configure() == Return.FAILURE
    lamp.bulb = True
    lamp.begin()
    assert lamp.active


def test_an_illegal_transition_ends_nothing(lamp):
    """Asked for over ROS, rclpy lets it escape from spin."""
    from lifecycle_msgs.msg import Transition
    from lifecycle_msgs.srv import ChangeState

    thread = threading.Thread(target=start_and_spin, args=(lamp,), daemon=True)
    thread.start()
    user = rclpy.create_node("user")
    client = user.create_client(ChangeState, "/lamp/change_state")
    assert client.wait_for_service(timeout_sec=60.0)

    def ask(transition: int):
        future = client.call_async(ChangeState.Request(transition=Transition(id=transition)))
        rclpy.spin_until_future_complete(user, future, timeout_sec=2.0)
        return future

    ask(Transition.TRANSITION_CLEANUP)  # illegal while active: nobody answers
    answer = ask(Transition.TRANSITION_DEACTIVATE)
    rclpy.spin_until_future_complete(user, answer, timeout_sec=60.0)
    assert answer.result().success
    user.destroy_node()
    rclpy.try_shutdown()
    thread.join(timeout=60.0)
    assert not thread.is_alive()
